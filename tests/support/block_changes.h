// Databases with more than heights, and their blocks changed with every length, identity and checksum right.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "formats/area.h"
#include "formats/container.h"
#include "tests/support/memory_file_system.h"

namespace deltaz {

// A grid of 31 x 31 posts of 30 arc-seconds with another of half the spacing inside: one seam. At
// kMemoryDatabasePath.
MemoryFileSystem areaWithInset();

// Puts what `change` leaves of the payloads into the file with this role.
void changeBlocks(MemoryFileSystem& files, FileRole role, ContentKind kind, BlockType type,
                  const std::function<void(std::vector<std::vector<std::byte>>&)>& change);

// The same for the first seam (formats/seam.md).
void changeSeam(MemoryFileSystem& files, const std::function<void(std::vector<std::byte>&)>& change);

}  // namespace deltaz
