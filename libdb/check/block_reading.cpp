#include "libdb/check/block_reading.h"

#include <fmt/format.h>

#include "libdb/check/report_detail.h"

namespace deltaz {

IssueLocation whereBlock(const CheckedFile& file, std::uint32_t block) {
  IssueLocation where;
  where.file = file.reference.name;
  where.block = block;
  return where;
}

std::optional<std::vector<std::byte>> readBlock(CheckedFile& file, std::uint32_t block, BlockType type,
                                                IssueCode code, Report& report) {
  if (block >= file.damaged_blocks.size()) {
    report.add(makeIssue(code, fmt::format("there is no block {}", block), whereBlock(file, block)));
    return std::nullopt;
  }
  if (file.damaged_blocks[block] != 0) return std::nullopt;
  const auto location = file.container->locate(block);
  if (location.ok() && location.value().type != type) {
    report.add(makeIssue(
        code,
        fmt::format("block {} is of type {}, not {}", block,
                    static_cast<std::uint32_t>(location.value().type), static_cast<std::uint32_t>(type)),
        whereBlock(file, block)));
    return std::nullopt;
  }
  auto bytes = file.container->read(block, type);
  if (bytes.ok()) return std::move(bytes).value();
  if (bytes.error().code == IssueCode::kSumBlock) file.damaged_blocks[block] = 1;
  addError(report, bytes.error(), whereBlock(file, block));
  return std::nullopt;
}

}  // namespace deltaz
