#include "formats/version.h"

namespace deltaz {

std::string_view version() {
  return DELTAZ_VERSION;
}

}  // namespace deltaz
