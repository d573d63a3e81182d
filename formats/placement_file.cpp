#include "formats/placement_file.h"

#include <cassert>
#include <cmath>

#include "formats/area.h"
#include "formats/bytes.h"

namespace deltaz {

namespace {

constexpr std::size_t kRecordBytes = 56, kDirectoryHeaderBytes = 16, kSphereBytes = 32;
constexpr std::uint32_t kOnGround = 1;
constexpr double kMostMetres = 1e9;  // Earth-centred

Error damaged(const std::string& where, const char* why) {
  return invalidError(IssueCode::kPlacementRecord, where, "this is no part of a list of placements", why);
}

const char* faultOf(const Placement& placement, std::size_t models) {
  if (placement.instance == 0) return "an instance has no number";
  if (placement.model >= models) return "it names a model that is not there";
  if (!(std::abs(placement.latitude) <= 90) || !(std::abs(placement.longitude) <= 180))
    return "a position is out of range";
  if (!(std::abs(placement.height) <= kMaximumHeightMetres) ||
      !(std::abs(placement.above_ground) <= kMaximumHeightMetres))
    return "a height is out of range";
  if (!placement.on_ground && placement.above_ground != 0)
    return "it is said to be above ground, and not to follow it";
  if (!(placement.heading >= 0 && placement.heading < 360)) return "a heading is out of range";
  return nullptr;
}

}  // namespace

std::vector<std::byte> encodePlacementDirectory(const PlacementDirectory& directory) {
  ByteWriter writer;
  writer.put(directory.count);
  writer.put(directory.next_instance);
  writer.put(static_cast<std::uint32_t>(directory.pages.size()));
  writer.putZeros(kDirectoryHeaderBytes - writer.size());
  for (const PlacementSphere& page : directory.pages) {
    for (const double value : page.centre) writer.put(value);
    writer.put(page.radius);
  }
  return writer.take();
}

Result<PlacementDirectory> decodePlacementDirectory(std::span<const std::byte> bytes, std::uint32_t blocks,
                                                    const std::string& where) {
  if (bytes.size() < kDirectoryHeaderBytes) return damaged(where, "the directory is too short");
  ByteReader reader(bytes);
  PlacementDirectory directory;
  directory.count = reader.get<std::uint32_t>();
  directory.next_instance = reader.get<std::uint32_t>();
  const auto pages = reader.get<std::uint32_t>();
  if (reader.get<std::uint32_t>() != 0) return damaged(where, "a reserved byte is not zero");
  if (reader.remaining() != std::size_t{pages} * kSphereBytes)
    return damaged(where, "the directory has the wrong length");
  if (std::uint64_t{pages} + 1 != blocks ||
      pages != (std::uint64_t{directory.count} + kPlacementsPerPage - 1) / kPlacementsPerPage)
    return damaged(where, "its counts are not those of the file");
  if (directory.next_instance == 0) return damaged(where, "it has run out of numbers");
  if (directory.count >= directory.next_instance)
    return damaged(where, "it has more placements than numbers were given");
  for (std::uint32_t k = 0; k < pages; ++k) {
    PlacementSphere page;
    for (double& value : page.centre) {
      value = reader.get<double>();
      if (!(std::abs(value) <= kMostMetres)) return damaged(where, "a page's sphere is out of range");
    }
    page.radius = reader.get<double>();
    if (!(page.radius >= 0 && page.radius <= kMostMetres))
      return damaged(where, "a page's sphere is out of range");
    directory.pages.push_back(page);
  }
  return directory;
}

std::vector<std::byte> encodePlacementPage(std::span<const Placement> placements) {
  assert(placements.size() <= kPlacementsPerPage);
  ByteWriter writer;
  for (const Placement& placement : placements) {
    writer.put(placement.instance);
    writer.put(placement.model);
    for (const double value : {placement.latitude, placement.longitude, placement.height, placement.heading,
                               placement.above_ground}) {
      writer.put(value);
    }
    writer.put(placement.on_ground ? kOnGround : std::uint32_t{0});
    writer.put(std::uint32_t{0});
  }
  return writer.take();
}

Result<std::vector<Placement>> decodePlacementPage(std::span<const std::byte> bytes, std::size_t models,
                                                   const std::string& where) {
  if (bytes.empty() || bytes.size() % kRecordBytes != 0 || bytes.size() > kRecordBytes * kPlacementsPerPage)
    return damaged(where, "a page has the wrong length");
  ByteReader reader(bytes);
  std::vector<Placement> placements(bytes.size() / kRecordBytes);
  for (Placement& placement : placements) {
    placement.instance = reader.get<std::uint32_t>();
    placement.model = reader.get<std::uint32_t>();
    placement.latitude = reader.get<double>();
    placement.longitude = reader.get<double>();
    placement.height = reader.get<double>();
    placement.heading = reader.get<double>();
    placement.above_ground = reader.get<double>();
    const auto flags = reader.get<std::uint32_t>();
    if (flags > kOnGround || reader.get<std::uint32_t>() != 0)
      return damaged(where, "a flag or a reserved byte is unknown");
    placement.on_ground = flags == kOnGround;
    if (const char* fault = faultOf(placement, models)) return damaged(where, fault);
  }
  return placements;
}

}  // namespace deltaz
