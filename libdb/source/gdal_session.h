// GDAL's edge. While a session lives, GDAL's messages of this thread are collected instead of printed, and
// GDAL verifies what it can: the checksums of DTED records, which it ignores otherwise.
#pragma once

#include <string>

namespace deltaz {

class GdalSession {
 public:
  GdalSession();
  ~GdalSession();
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  // The last failure GDAL reported in this session, empty if it gave no reason.
  std::string lastFailure() const;
  bool hasFailed() const { return failures() > 0; }
  // How many failures GDAL reported so far: some drivers report one and go on.
  int failures() const { return log_.failures; }

 private:
  struct Log {
    std::string last;
    int failures = 0;
  };
  friend struct GdalMessages;
  Log log_;
};

}  // namespace deltaz
