#include "libdb/source/reference_system.h"

#include <array>
#include <cmath>
#include <cpl_conv.h>
#include <fmt/format.h>
#include <limits>
#include <ogr_spatialref.h>
#include <vector>

#include "libdb/source/source_error.h"

namespace deltaz {

namespace {

// Seconds of arc that a prime meridian may be off and still be Greenwich.
constexpr double kDegree = 0.017453292519943295;

OGRSpatialReference fromWkt(const std::string& wkt) {
  OGRSpatialReference reference;
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  (void)reference.importFromWkt(wkt.c_str());
  return reference;
}

OGRSpatialReference horizontalPart(const ReferenceSystem& system) {
  OGRSpatialReference reference = fromWkt(system.wkt);
  if (reference.IsCompound()) reference.StripVertical();
  reference.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  if (system.epoch) reference.SetCoordinateEpoch(*system.epoch);
  return reference;
}

std::string wktOf(const OGRSpatialReference& reference) {
  char* wkt = nullptr;
  const std::array<const char*, 2> options = {"FORMAT=WKT2_2018", nullptr};
  reference.exportToWkt(&wkt, options.data());
  std::string text = wkt == nullptr ? "" : wkt;
  CPLFree(wkt);
  return text;
}

std::string textOr(const char* text, const char* otherwise) {
  return text == nullptr ? otherwise : text;
}

Result<ReferenceSystem> describe(const OGRSpatialReference& stated, const std::string& where) {
  ReferenceSystem system;
  OGRSpatialReference horizontal(stated);
  if (stated.IsCompound()) horizontal.StripVertical();
  system.projected = horizontal.IsProjected() != 0;
  system.name = textOr(stated.GetName(), "unnamed");
  if (!system.projected && !horizontal.IsGeographic()) {
    return refusedSource(
        where, fmt::format("the reference system '{}' is neither geographic nor projected", system.name),
        "its coordinates cannot be placed on the Earth",
        where.starts_with("--") ? "Name a geographic or a projected one" : "Give the right one with --crs");
  }
  if (horizontal.IsDerivedGeographic() != 0) {
    return refusedSource(
        where, fmt::format("the coordinates of '{}' are no latitudes and longitudes", system.name),
        "they are derived from such, as those of a rotated pole are",
        where.starts_with("--") ? "Name a geographic or a projected one"
                                : "Warp the source to latitudes and longitudes, with gdalwarp -t_srs");
  }
  if (std::abs(horizontal.GetPrimeMeridian()) > 0) {
    return refusedSource(where, fmt::format("the prime meridian of '{}' is not Greenwich", system.name), {},
                         "Warp the source to a system that counts from Greenwich, with gdalwarp -t_srs");
  }
  if (system.projected) {
    system.metres_per_unit = horizontal.GetLinearUnits();
  } else if (std::abs(horizontal.GetAngularUnits() - kDegree) > 1e-12) {
    return refusedSource(where, fmt::format("the coordinates of '{}' are not in degrees", system.name), {},
                         "Warp the source to a system in degrees, with gdalwarp -t_srs");
  }
  OGRErr failed = OGRERR_NONE;
  system.ellipsoid.semi_major_axis = horizontal.GetSemiMajor(&failed);
  if (failed != OGRERR_NONE)
    return refusedSource(where, fmt::format("the reference system '{}' has no ellipsoid", system.name));
  system.ellipsoid.inverse_flattening = horizontal.GetInvFlattening();
  system.horizontal_datum = textOr(horizontal.GetAttrValue("DATUM"), "unknown");
  system.vertical_datum = textOr(stated.IsCompound() ? stated.GetAttrValue("VERT_CS") : nullptr, "unknown");
  if (stated.IsCompound()) {
    const char* name = nullptr;
    (void)stated.GetTargetLinearUnits("VERT_CS", &name);
    system.vertical_unit = textOr(name, "");
  }
  system.wkt = wktOf(stated);
  // WKT has no room for the epoch of coordinates in a dynamic datum.
  if (stated.GetCoordinateEpoch() > 0) system.epoch = stated.GetCoordinateEpoch();
  return system;
}

}  // namespace

Result<ReferenceSystem> parseReferenceSystem(const std::string& text, const std::string& where,
                                             std::optional<double> epoch) {
  OGRSpatialReference reference;
  // A local file or the network is never asked what a system is.
  const std::array<const char*, 3> limits = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  if (reference.SetFromUserInput(text.c_str(), limits.data()) != OGRERR_NONE) {
    const std::string why = CPLGetLastErrorMsg();
    return usageError(where, fmt::format("'{}' is not a coordinate reference system", text), why);
  }
  if (epoch) reference.SetCoordinateEpoch(*epoch);
  return describe(reference, where);
}

bool sameHorizontalSystem(const ReferenceSystem& a, const ReferenceSystem& b) {
  if (a.wkt == b.wkt && a.epoch == b.epoch) return true;
  const OGRSpatialReference of_a = horizontalPart(a), of_b = horizontalPart(b);
  const std::array<const char*, 3> criteria = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES",
                                               "CRITERION=EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS", nullptr};
  return of_a.IsSame(&of_b, criteria.data()) != 0;
}

bool sameDatum(const ReferenceSystem& a, const ReferenceSystem& b) {
  if (a.wkt == b.wkt && a.epoch == b.epoch) return true;
  if (a.ellipsoid != b.ellipsoid) return false;
  const OGRSpatialReference of_a = horizontalPart(a), of_b = horizontalPart(b);
  return of_a.IsSameGeogCS(&of_b) != 0;
}

Result<ReferenceSystem> geographicOf(const ReferenceSystem& system, const std::string& where) {
  const OGRSpatialReference horizontal = horizontalPart(system);
  const std::unique_ptr<OGRSpatialReference> geographic(horizontal.CloneGeogCS());
  if (!geographic) return refusedSource(where, fmt::format("'{}' has no geographic system", system.name));
  if (system.epoch) geographic->SetCoordinateEpoch(*system.epoch);
  return describe(*geographic, where);
}

struct CoordinateChange::Handle {
  std::unique_ptr<OGRCoordinateTransformation> transformation;  // none: both systems are the same
};

Result<CoordinateChange> CoordinateChange::between(const ReferenceSystem& from, const ReferenceSystem& to,
                                                   bool allow_ballpark, const std::string& where) {
  CoordinateChange change;
  auto handle = std::make_shared<Handle>();
  if (!sameHorizontalSystem(from, to)) {
    const OGRSpatialReference source = horizontalPart(from), target = horizontalPart(to);
    OGRCoordinateTransformationOptions options;
    options.SetBallparkAllowed(allow_ballpark);
    handle->transformation.reset(OGRCreateCoordinateTransformation(&source, &target, options));
    if (!handle->transformation) {
      return refusedSource(where, fmt::format("there is no way from '{}' to '{}'", from.name, to.name),
                           CPLGetLastErrorMsg());
    }
  }
  change.handle_ = std::move(handle);
  return change;
}

bool CoordinateChange::apply(std::span<double> x, std::span<double> y) const {
  if (!handle_->transformation || x.empty()) return true;
  // GDAL takes an int, and does its work in one go.
  constexpr std::size_t kMost = 1 << 20;
  bool all = true;
  std::vector<int> good;
  for (std::size_t first = 0; first < x.size(); first += kMost) {
    const std::size_t count = std::min(kMost, x.size() - first);
    good.assign(count, 0);
    // The transformation is not changed by being used, but for caches of PROJ's.
    OGRCoordinateTransformation& transformation = *handle_->transformation;
    (void)transformation.Transform(static_cast<int>(count), x.data() + first, y.data() + first, nullptr,
                                   nullptr, good.data());
    for (std::size_t k = 0; k < count; ++k) {
      if (good[k] != 0 && std::isfinite(x[first + k]) && std::isfinite(y[first + k])) continue;
      x[first + k] = y[first + k] = std::numeric_limits<double>::quiet_NaN();
      all = false;
    }
  }
  return all;
}

}  // namespace deltaz
