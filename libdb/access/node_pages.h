// Reads pages of node records, of whichever form the database has. Errors: those of the container, and
// kInvalid with kRefRecord. Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/area.h"
#include "formats/container.h"
#include "formats/node_file.h"

namespace deltaz {

// How many pages the records of an area need.
std::uint32_t nodePageCount(const AreaHeader& area);

// The records of page `page`, which has as many as it must: full pages, then one with what is left.
Result<std::vector<NodeRecord>> readNodePage(const ContainerReader& nodes, const AreaHeader& area,
                                             std::uint32_t page);

}  // namespace deltaz
