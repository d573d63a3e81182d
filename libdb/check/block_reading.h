// How the rules of colour maps, models and placements read blocks: damage that was reported once is not
// reported again. Internal to libdb/check. Thread-safety: different blocks from any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "libdb/check/check_context.h"

namespace deltaz {

// Where a finding about a block stands.
IssueLocation whereBlock(const CheckedFile& file, std::uint32_t block);

// The payload of a block. Nothing, and a finding unless there was one already, if it cannot be read; under
// `code` if it is there and not of type `type`. Pre: the file is open.
std::optional<std::vector<std::byte>> readBlock(CheckedFile& file, std::uint32_t block, BlockType type,
                                                IssueCode code, Report& report);

}  // namespace deltaz
