#include "libdb/source/stated_system.h"

#include <array>
#include <cpl_conv.h>
#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

namespace deltaz {

namespace {

Result<ReferenceSystem> ownSystem(const OGRSpatialReference& stated, const std::string& path) {
  std::optional<double> epoch;
  if (stated.GetCoordinateEpoch() > 0) epoch = stated.GetCoordinateEpoch();
  char* wkt = nullptr;
  const std::array<const char*, 2> format = {"FORMAT=WKT2_2018", nullptr};
  stated.exportToWkt(&wkt, format.data());
  const std::string text = wkt == nullptr ? "" : wkt;
  CPLFree(wkt);
  return parseReferenceSystem(text, path, epoch);
}

}  // namespace

Result<ReferenceSystem> statedSystem(GDALDataset& dataset, const std::string& path, const std::string& crs,
                                     std::vector<std::string>& warnings) {
  const OGRSpatialReference* const stated = dataset.GetSpatialRef();
  if (crs.empty()) {
    if (stated != nullptr) return ownSystem(*stated, path);
    return usageError(path, "the source does not say what its coordinates refer to",
                      "it has no coordinate reference system",
                      "Give one with --crs, for example --crs EPSG:4326");
  }
  DELTAZ_TRY_ASSIGN(const ReferenceSystem given, parseReferenceSystem(crs, "--crs"));
  if (stated != nullptr) {
    const Result<ReferenceSystem> said = ownSystem(*stated, path);
    if (!said.ok() || !sameHorizontalSystem(said.value(), given)) {
      warnings.push_back(fmt::format("{}: --crs '{}' is used, although the source says '{}'", path,
                                     given.name, said.ok() ? said.value().name : stated->GetName()));
    }
  }
  return given;
}

std::vector<std::string> membersOfVirtual(GDALDataset& dataset) {
  std::vector<std::string> members;
  if (!EQUAL(dataset.GetDriverName(), "VRT")) return members;
  const CPLStringList names(dataset.GetFileList());
  for (int i = 0; i < names.size(); ++i) members.emplace_back(names[i]);
  return members;
}

}  // namespace deltaz
