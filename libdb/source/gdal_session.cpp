#include "libdb/source/gdal_session.h"

#include <cpl_error.h>
#include <gdal.h>
#include <mutex>

namespace deltaz {

namespace {

void CPL_STDCALL collect(CPLErr severity, CPLErrorNum, const char* message) {
  if (severity >= CE_Failure) *static_cast<std::string*>(CPLGetErrorHandlerUserData()) = message;
}

}  // namespace

GdalSession::GdalSession() {
  static std::once_flag registered;
  std::call_once(registered, GDALAllRegister);
  CPLPushErrorHandlerEx(collect, &failure_);
}

GdalSession::~GdalSession() {
  CPLPopErrorHandler();
}

std::string GdalSession::lastFailure() const {
  return failure_.empty() ? "no reason given" : failure_;
}

}  // namespace deltaz
