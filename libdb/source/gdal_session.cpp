#include "libdb/source/gdal_session.h"

#include <algorithm>
#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal.h>
#include <mutex>

namespace deltaz {

namespace {

constexpr const char* kVerifyDted = "DTED_VERIFY_CHECKSUM";

}  // namespace

// What GDAL calls.
struct GdalMessages {
  static void CPL_STDCALL collect(CPLErr severity, CPLErrorNum, const char* message) {
    if (severity < CE_Failure) return;
    auto& log = *static_cast<GdalSession::Log*>(CPLGetErrorHandlerUserData());
    log.last = message;
    ++log.failures;
  }
};

GdalSession::GdalSession() {
  static std::once_flag registered;
  std::call_once(registered, GDALAllRegister);
  CPLPushErrorHandlerEx(GdalMessages::collect, &log_);
  CPLSetThreadLocalConfigOption(kVerifyDted, "YES");
}

GdalSession::~GdalSession() {
  CPLSetThreadLocalConfigOption(kVerifyDted, nullptr);
  CPLPopErrorHandler();
}

std::string GdalSession::lastFailure() const {
  std::string text = log_.last;
  // An error is one line.
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace deltaz
