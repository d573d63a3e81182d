// The version of deltaz, "0.1.0", as CMakeLists.txt states it.
#pragma once

#include <string_view>

namespace deltaz {

std::string_view version();

}  // namespace deltaz
