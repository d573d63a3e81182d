#include "formats/node_file.h"

#include <cassert>
#include <fmt/format.h>

#include "formats/bytes.h"

namespace deltaz {

namespace {

constexpr std::uint8_t kKnownFlags = kNodeHasVoids | kNodeIsEmpty;

void encode(ByteWriter& writer, const NodeRecord& record) {
  const std::size_t start = writer.size();
  writer.put(static_cast<std::uint8_t>(record.type));
  writer.put(record.level);
  writer.put(record.child_number);
  writer.put(record.flags);
  writer.put(record.grid);
  writer.put(std::uint16_t{0});
  writer.put(record.x);
  writer.put(record.y);
  writer.put(record.first_child);
  writer.put(record.sibling);
  writer.put(record.segment);
  writer.put(record.block);
  for (const std::int32_t offset : record.centroid_offset) writer.put(offset);
  writer.put(record.radius);
  writer.put(record.minimum_height);
  writer.put(record.maximum_height);
  for (const std::int16_t component : record.mean_normal) writer.put(component);
  writer.put(record.cone_half_angle);
  writer.put(record.geometric_error);
  writer.put(record.coverage_error);
  writer.put(record.rms_error);
  writer.put(record.lod_near);
  writer.put(record.lod_far);
  writer.put(record.valid_posts);
  writer.putZeros(kNodeRecordBytes - (writer.size() - start));
}

// What a record can be wrong in by itself; empty if nothing.
std::string faultOf(const NodeRecord& record, std::uint8_t type, bool reserved_zero) {
  if (!reserved_zero) return "a reserved byte is not zero";
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

std::vector<std::byte> encodeNodePage(std::span<const NodeRecord> records) {
  assert(!records.empty() && records.size() <= kNodesPerPage);
  ByteWriter writer;
  for (const NodeRecord& record : records) encode(writer, record);
  return writer.take();
}

Result<std::vector<NodeRecord>> decodeNodePage(std::span<const std::byte> bytes, const std::string& where) {
  if (bytes.empty() || bytes.size() % kNodeRecordBytes != 0 ||
      bytes.size() / kNodeRecordBytes > kNodesPerPage) {
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
    if (const std::string fault = faultOf(record, type, reserved_zero); !fault.empty()) {
      return invalidError(IssueCode::kRefRecord, where,
                          fmt::format("record {} of the page is damaged", records.size()), fault);
    }
    records.push_back(record);
  }
  return records;
}

}  // namespace deltaz
