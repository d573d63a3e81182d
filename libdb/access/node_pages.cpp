#include "libdb/access/node_pages.h"

#include <algorithm>
#include <fmt/format.h>

namespace deltaz {

std::uint32_t nodePageCount(const AreaHeader& area) {
  return (area.node_count - 1) / area.nodes_per_page + 1;
}

Result<std::vector<NodeRecord>> readNodePage(const ContainerReader& nodes, const AreaHeader& area,
                                             std::uint32_t page) {
  const bool plain = area.nodes_per_page == kNodesPerPlainPage;
  const std::uint32_t before = page * area.nodes_per_page;
  const std::uint32_t expected = std::min(area.nodes_per_page, area.node_count - before);
  DELTAZ_TRY_ASSIGN(const std::vector<std::byte> bytes,
                    nodes.read(page, plain ? BlockType::kNodePage : BlockType::kPackedNodePage));
  const std::string where = fmt::format("{}, block {}", nodes.path(), page);
  DELTAZ_TRY_ASSIGN(std::vector<NodeRecord> records,
                    plain ? decodePlainNodePage(bytes, where) : decodeNodePage(bytes, before + 1, where));
  if (records.size() != expected) {
    return invalidError(IssueCode::kRefRecord, nodes.path(),
                        fmt::format("page {} has {} records, not {}", page, records.size(), expected));
  }
  return records;
}

}  // namespace deltaz
