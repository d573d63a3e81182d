#include "tests/support/synthetic_grid.h"

#include <stdexcept>

namespace deltaz {

MemoryFileSystem buildInMemory(const RawGrid& grid, const BuildOptions& options, const std::string& path) {
  MemoryFileSystem files;
  for (std::size_t slash = path.find('/', 1); slash != std::string::npos; slash = path.find('/', slash + 1)) {
    if (const Status made = files.makeDirectory(path.substr(0, slash)); !made.ok()) {
      throw std::runtime_error(made.error().message());
    }
  }
  if (const auto built = buildTerrain(files, grid, path, options); !built.ok()) {
    throw std::runtime_error(built.error().message());
  }
  return files;
}

}  // namespace deltaz
