#include "libdb/build/placement_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "formats/container.h"
#include "libdb/access/model.h"

namespace deltaz {

namespace {

// Every second bit is free for the other axis.
std::uint64_t spread(std::uint32_t value) {
  std::uint64_t bits = value;
  bits = (bits | (bits << 16)) & 0x0000FFFF0000FFFF;
  bits = (bits | (bits << 8)) & 0x00FF00FF00FF00FF;
  bits = (bits | (bits << 4)) & 0x0F0F0F0F0F0F0F0F;
  bits = (bits | (bits << 2)) & 0x3333333333333333;
  return (bits | (bits << 1)) & 0x5555555555555555;
}

std::uint64_t mortonNumber(const Placement& placement) {
  // Steps of 360 / 2^32 degrees, about a centimetre.
  constexpr double kSteps = 4294967295.0 / 360.0;
  const auto column = static_cast<std::uint32_t>((placement.longitude + 180) * kSteps);
  const auto row = static_cast<std::uint32_t>((placement.latitude + 90) * kSteps);
  return spread(column) | (spread(row) << 1);
}

}  // namespace

void sortPlacements(std::vector<Placement>& placements) {
  std::sort(placements.begin(), placements.end(), [](const Placement& a, const Placement& b) {
    const std::uint64_t left = mortonNumber(a), right = mortonNumber(b);
    return left != right ? left < right : a.instance < b.instance;
  });
}

PlacementSphere placementSphere(std::span<const Placement> placements, std::span<const ModelTree> models,
                                const EllipsoidShape& ellipsoid) {
  std::vector<Vector3> centres;
  std::array<double, 3> low{}, high{};
  for (const Placement& placement : placements) {
    const ModelTree& model = models[placement.model];
    const ModelTransform to_earth = placementTransform(placement, model.anchor, ellipsoid);
    const Vector3 centre = transformPoint(to_earth, {model.centre[0], model.centre[1], model.centre[2]});
    const bool first = centres.empty();
    centres.push_back(centre);
    const std::array<double, 3> coordinates = {centre.x, centre.y, centre.z};
    for (std::size_t i = 0; i < 3; ++i) {
      const double least = coordinates[i] - model.radius, most = coordinates[i] + model.radius;
      low[i] = first ? least : std::min(low[i], least);
      high[i] = first ? most : std::max(high[i], most);
    }
  }
  PlacementSphere sphere;
  for (std::size_t i = 0; i < 3; ++i) sphere.centre[i] = (low[i] + high[i]) / 2;
  const Vector3 middle{sphere.centre[0], sphere.centre[1], sphere.centre[2]};
  for (std::size_t k = 0; k < centres.size(); ++k)
    sphere.radius = std::max(sphere.radius, length(centres[k] - middle) + models[placements[k].model].radius);
  // More than the rounding of coordinates of the Earth's size.
  constexpr double kRounding = 1e-7;
  sphere.radius = sphere.radius * (1 + 1e-12) + kRounding;
  return sphere;
}

Status writePlacements(const FileSystem& files, Publication& publication, AreaHeader& area,
                       std::vector<Placement> placements, std::uint32_t next_instance,
                       std::span<const ModelTree> models) {
  sortPlacements(placements);
  const std::string name = fmt::format("placements-{:06}.dzl", publication.generation());
  DELTAZ_TRY_ASSIGN(ContainerWriter writer,
                    ContainerWriter::create(files, publication.newFilePath(name), ContentKind::kPlacements));
  PlacementDirectory directory;
  directory.count = static_cast<std::uint32_t>(placements.size());
  directory.next_instance = next_instance;
  for (std::size_t first = 0; first < placements.size(); first += kPlacementsPerPage) {
    const std::span<const Placement> page =
        std::span(placements)
            .subspan(first, std::min<std::size_t>(kPlacementsPerPage, placements.size() - first));
    DELTAZ_TRY_ASSIGN([[maybe_unused]] const std::uint32_t block,
                      writer.append(BlockType::kPlacementPage, encodePlacementPage(page)));
    directory.pages.push_back(placementSphere(page, models, area.grids.front().ellipsoid));
  }
  DELTAZ_TRY_ASSIGN([[maybe_unused]] const std::uint32_t block,
                    writer.append(BlockType::kPlacementDirectory, encodePlacementDirectory(directory)));
  DELTAZ_TRY_ASSIGN(const FileIdentity identity, writer.finish());
  std::erase_if(area.files, [](const FileReference& file) { return file.role == FileRole::kPlacements; });
  area.files.push_back({FileRole::kPlacements, 0, name, identity.length, identity.id});
  return Success{};
}

}  // namespace deltaz
