// For tests, which know it by this name.
#pragma once

#include "formats/memory_file_system.h"  // IWYU pragma: export
