// Makes the tiles of a colour map over one grid from a field: depth first, so that memory grows with the
// square root of the number of tiles only; and the same bytes for any number of threads.
//
// Where a node has a child its texels are the means of the child's stored ones (meanTexel), elsewhere they
// are the field's. A tile's border is its neighbours' texels where those nodes exist, else the field's. Nodes
// without any cover do not exist. Beyond the grid texels repeat the nearest that hold a part of it, so that
// no level mixes what is not there into the colours at its edge.
#pragma once

#include <functional>
#include <optional>

#include "formats/area.h"
#include "libdb/build/color_field.h"
#include "libdb/build/color_map_writer.h"
#include "libdb/build/worker_pool.h"

namespace deltaz {

struct ColorPyramidOptions {
  // Every node the field touches is there down to this level, and none below; none: as the field is fine.
  std::optional<int> last_level = {};
  std::function<void(double fraction)> progress = {};
};

// Errors: the field's and the writer's.
Status buildColorPyramid(std::uint16_t number, const GridHeader& grid, const ColorField& field,
                         const ColorPyramidOptions& options, WorkerPool& workers, ColorMapWriter& writer);

}  // namespace deltaz
