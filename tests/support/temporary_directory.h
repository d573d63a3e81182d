// A folder of the test's own, removed with everything in it when the object goes.
#pragma once

#include <string>

namespace deltaz {

class TemporaryDirectory {
 public:
  // Throws std::runtime_error if none can be made.
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  const std::string& path() const { return path_; }
  // A path inside it.
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace deltaz
