#include "formats/node_file.h"

#include <array>
#include <bit>
#include <cassert>
#include <fmt/format.h>
#include <limits>

#include "formats/bit_columns.h"
#include "formats/bytes.h"

namespace deltaz {

namespace {

constexpr std::uint8_t kKnownFlags = kNodeHasVoids | kNodeIsEmpty;

// A page as columns, in this order. Some hold not the field but its difference from what it most often is, so
// that they take few bits; node_file.md, section 5.
enum Column : std::size_t {
  kType,
  kLevel,
  kChildNumber,
  kFlags,
  kGrid,
  kX,
  kY,
  kFirstChild,
  kSibling,
  kSegment,
  kBlock,
  kCentroidX,
  kCentroidY,
  kCentroidZ,
  kRadius,
  kMinimumHeight,
  kHeightRange,
  kNormalX,
  kNormalY,
  kNormalZ,
  kCone,
  kGeometric,
  kCoverage,
  kRms,
  kLodNear,
  kLodFar,
  kValidPosts,
  kColumnCount
};

using ColumnValues = std::array<std::int64_t, kColumnCount>;

constexpr std::int64_t kMostChildren = 4;

// 0 for none; else how far behind the record, which is nearly always 1.
std::int64_t siblingStep(std::uint32_t sibling, std::int64_t number) {
  if (sibling == 0) return 0;
  const std::int64_t step = sibling - number;
  return step > 0 ? step : step - 1;
}

std::int64_t siblingAfter(std::int64_t step, std::int64_t number) {
  if (step == 0) return 0;
  return number + (step > 0 ? step : step + 1);
}

ColumnValues columnsOf(const NodeRecord& record, std::int64_t slot, std::int64_t first_number) {
  return {static_cast<std::int64_t>(record.type),
          record.level,
          record.child_number,
          record.flags,
          record.grid,
          record.x,
          record.y,
          record.first_child == 0 ? 0 : record.first_child + kMostChildren * (kNodesPerPage - slot),
          siblingStep(record.sibling, first_number + slot),
          record.segment,
          record.block - slot,
          record.centroid_offset[0],
          record.centroid_offset[1],
          record.centroid_offset[2],
          record.radius,
          record.minimum_height,
          std::int64_t{record.maximum_height} - record.minimum_height,
          record.mean_normal[0],
          record.mean_normal[1],
          record.mean_normal[2],
          record.cone_half_angle,
          record.geometric_error,
          record.coverage_error,
          record.rms_error,
          std::bit_cast<std::uint32_t>(record.lod_near),
          std::bit_cast<std::uint32_t>(record.lod_far),
          record.valid_posts};
}

// Puts values into fields, and notices those that do not fit.
class FieldFiller {
 public:
  template <typename T>
  void fill(T& field, std::int64_t value) {
    fits_ = fits_ && value >= std::int64_t{std::numeric_limits<T>::min()} &&
            value <= std::int64_t{std::numeric_limits<T>::max()};
    field = static_cast<T>(value);
  }
  void fill(float& field, std::int64_t value) {
    std::uint32_t bits = 0;
    fill(bits, value);
    field = std::bit_cast<float>(bits);
  }
  bool fits() const { return fits_; }

 private:
  bool fits_ = true;
};

// False if a value does not fit its field. `type` is the record's, known or not.
bool recordOf(const ColumnValues& values, std::int64_t slot, std::int64_t first_number, NodeRecord& record,
              std::uint8_t& type) {
  FieldFiller filler;
  filler.fill(type, values[kType]);
  record.type = static_cast<NodeType>(type);
  filler.fill(record.level, values[kLevel]);
  filler.fill(record.child_number, values[kChildNumber]);
  filler.fill(record.flags, values[kFlags]);
  filler.fill(record.grid, values[kGrid]);
  filler.fill(record.x, values[kX]);
  filler.fill(record.y, values[kY]);
  const std::int64_t child = values[kFirstChild];
  filler.fill(record.first_child, child == 0 ? 0 : child - kMostChildren * (kNodesPerPage - slot));
  filler.fill(record.sibling, siblingAfter(values[kSibling], first_number + slot));
  filler.fill(record.segment, values[kSegment]);
  filler.fill(record.block, values[kBlock] + slot);
  for (std::size_t i = 0; i < 3; ++i) filler.fill(record.centroid_offset[i], values[kCentroidX + i]);
  filler.fill(record.radius, values[kRadius]);
  filler.fill(record.minimum_height, values[kMinimumHeight]);
  filler.fill(record.maximum_height, values[kMinimumHeight] + values[kHeightRange]);
  for (std::size_t i = 0; i < 3; ++i) filler.fill(record.mean_normal[i], values[kNormalX + i]);
  filler.fill(record.cone_half_angle, values[kCone]);
  filler.fill(record.geometric_error, values[kGeometric]);
  filler.fill(record.coverage_error, values[kCoverage]);
  filler.fill(record.rms_error, values[kRms]);
  filler.fill(record.lod_near, values[kLodNear]);
  filler.fill(record.lod_far, values[kLodFar]);
  filler.fill(record.valid_posts, values[kValidPosts]);
  return filler.fits();
}

// What a record can be wrong in by itself; empty if nothing.
std::string faultOf(const NodeRecord& record, std::uint8_t type) {
  if (type > static_cast<std::uint8_t>(NodeType::kTerrain))
    return fmt::format("node type {} is unknown", type);
  if ((record.flags & ~kKnownFlags) != 0) return fmt::format("flags {:#x} are unknown", record.flags);
  if (record.child_number > 4) return fmt::format("child number {} is not 0 to 4", record.child_number);
  if (record.minimum_height > record.maximum_height) return "its lowest height is above its highest";
  if (!(record.lod_near >= 0) || !(record.lod_far >= record.lod_near))
    return "its LOD ranges are not in order";
  if (record.type == NodeType::kTerrain && record.block == kNoBlock) return "a terrain node has no data";
  if (record.type == NodeType::kCluster && record.block != kNoBlock) return "a cluster node has data";
  return {};
}

}  // namespace

std::vector<std::byte> encodeNodePage(std::span<const NodeRecord> records, std::uint32_t first_number) {
  assert(!records.empty() && records.size() <= kNodesPerPage);
  BitColumns columns;
  columns.rows = records.size();
  columns.values.resize(kColumnCount * columns.rows);
  for (std::size_t slot = 0; slot < columns.rows; ++slot) {
    const ColumnValues values = columnsOf(records[slot], static_cast<std::int64_t>(slot), first_number);
    for (std::size_t column = 0; column < kColumnCount; ++column)
      columns.values[column * columns.rows + slot] = values[column];
  }
  return packColumns(columns);
}

Result<std::vector<NodeRecord>> decodeNodePage(std::span<const std::byte> bytes, std::uint32_t first_number,
                                               const std::string& where) {
  const std::optional<BitColumns> columns = unpackColumns(bytes, kColumnCount, kNodesPerPage);
  if (!columns) {
    return invalidError(IssueCode::kRefRecord, where,
                        fmt::format("{} bytes are not a packed page of node records", bytes.size()));
  }
  std::vector<NodeRecord> records(columns->rows);
  for (std::size_t slot = 0; slot < records.size(); ++slot) {
    ColumnValues values;
    for (std::size_t column = 0; column < kColumnCount; ++column)
      values[column] = columns->values[column * columns->rows + slot];
    NodeRecord& record = records[slot];
    std::uint8_t type = 0;
    const bool fits = recordOf(values, static_cast<std::int64_t>(slot), first_number, record, type) &&
                      columnsOf(record, static_cast<std::int64_t>(slot), first_number) == values;
    if (const std::string fault = fits ? faultOf(record, type) : "a value does not fit its field";
        !fault.empty()) {
      return invalidError(IssueCode::kRefRecord, where, fmt::format("record {} of the page is damaged", slot),
                          fault);
    }
  }
  return records;
}

Result<std::vector<NodeRecord>> decodePlainNodePage(std::span<const std::byte> bytes,
                                                    const std::string& where) {
  if (bytes.empty() || bytes.size() % kPlainNodeRecordBytes != 0 ||
      bytes.size() / kPlainNodeRecordBytes > kNodesPerPlainPage) {
    return invalidError(IssueCode::kRefRecord, where,
                        fmt::format("a node page of {} bytes is not made of records", bytes.size()));
  }
  std::vector<NodeRecord> records;
  ByteReader reader(bytes);
  while (reader.remaining() > 0) {
    NodeRecord record;
    const auto type = reader.get<std::uint8_t>();
    record.type = static_cast<NodeType>(type);
    record.level = reader.get<std::uint8_t>();
    record.child_number = reader.get<std::uint8_t>();
    record.flags = reader.get<std::uint8_t>();
    record.grid = reader.get<std::uint16_t>();
    bool reserved_zero = reader.get<std::uint16_t>() == 0;
    record.x = reader.get<std::int32_t>();
    record.y = reader.get<std::int32_t>();
    record.first_child = reader.get<std::uint32_t>();
    record.sibling = reader.get<std::uint32_t>();
    record.segment = reader.get<std::uint32_t>();
    record.block = reader.get<std::uint32_t>();
    for (std::int32_t& offset : record.centroid_offset) offset = reader.get<std::int32_t>();
    record.radius = reader.get<std::uint32_t>();
    record.minimum_height = reader.get<std::int32_t>();
    record.maximum_height = reader.get<std::int32_t>();
    for (std::int16_t& component : record.mean_normal) component = reader.get<std::int16_t>();
    record.cone_half_angle = reader.get<std::uint16_t>();
    record.geometric_error = reader.get<std::uint32_t>();
    record.coverage_error = reader.get<std::uint32_t>();
    record.rms_error = reader.get<std::uint32_t>();
    record.lod_near = reader.get<float>();
    record.lod_far = reader.get<float>();
    record.valid_posts = reader.get<std::uint32_t>();
    reserved_zero = reader.get<std::uint64_t>() == 0 && reserved_zero;
    const std::string fault = reserved_zero ? faultOf(record, type) : "a reserved byte is not zero";
    if (!fault.empty()) {
      return invalidError(IssueCode::kRefRecord, where,
                          fmt::format("record {} of the page is damaged", records.size()), fault);
    }
    records.push_back(record);
  }
  return records;
}

}  // namespace deltaz
