#include "librender/scene/environment.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <string>

namespace deltaz {
namespace {

Status checkOptions(const RenderOptions& options) {
  const Camera& camera = options.camera;
  if (camera.width < 1 || camera.height < 1 || camera.width > kLargestPicture ||
      camera.height > kLargestPicture)
    return usageError("picture size", "must be 1 to 16384 pixels each way");
  if (!(camera.field_of_view > 0 && camera.field_of_view < 180))
    return usageError("field of view", "must be more than 0 and less than 180 degrees");
  if (!(std::abs(camera.eye.latitude) <= 90))
    return usageError("eye", "latitude must be -90 to 90 degrees",
                      "it comes first: latitude, longitude, height");
  const double values[] = {camera.eye.longitude, camera.eye.height,   camera.heading,       camera.pitch,
                           camera.roll,          options.sun.azimuth, options.sun.elevation};
  for (const double value : values) {
    if (!std::isfinite(value)) return usageError("view", "eye, look and sun must be finite numbers");
  }
  if (!(options.tolerance >= 0)) return usageError("tolerance", "must be 0 or more pixels");
  return Success{};
}

}  // namespace

Result<const ColorMap*> chooseColorMap(const Database& database, const std::string& name) {
  const std::vector<ColorMap>& maps = database.colorMaps();
  if (name == kNoColorMap || (name.empty() && maps.empty())) return nullptr;
  if (name.empty()) return &maps.front();
  if (const auto index = database.findColorMap(name)) return &maps[*index];
  std::string names;
  for (const AssetHeader& map : database.area().color_maps) names += (names.empty() ? "" : ", ") + map.name;
  return usageError(database.path(), fmt::format("there is no colour map '{}'", name),
                    names.empty() ? "the database has none at all" : "it has " + names,
                    fmt::format("Give the name of one, or '{}' for colours by rule", kNoColorMap));
}

Result<Environment> makeEnvironment(const Database& database, const RenderOptions& options) {
  DELTAZ_TRY(checkOptions(options));
  if (database.gridCount() < 1) return usageError(database.path(), "has no grid to draw");
  const AreaHeader& area = database.area();
  const EllipsoidShape& ellipsoid = area.grids.front().ellipsoid;
  const ViewTransform view = makeViewTransform(options.camera, ellipsoid);
  const Light light = makeLight(area, options.sun);
  const Atmosphere atmosphere(ellipsoid, view, light.to_sun);
  DELTAZ_TRY_ASSIGN(const ColorMap* const color_map, chooseColorMap(database, options.color_map));
  return Environment{view, light, atmosphere, Sea(area, view, light, atmosphere), color_map};
}

Picture makePicture(const RenderOptions& options) {
  const auto pixels =
      static_cast<std::size_t>(options.camera.width) * static_cast<std::size_t>(options.camera.height);
  Picture picture;
  picture.width = options.camera.width;
  picture.height = options.camera.height;
  picture.rgb.resize(pixels * 3);
  picture.depth.resize(pixels, std::numeric_limits<float>::infinity());
  picture.surface.resize(pixels, Surface::kSky);
  if (options.keep_triangle_ids) picture.triangle.resize(pixels, 0);
  return picture;
}

LinearColor seenColor(const Environment& environment, const Vector3& ray, Surface surface, double u,
                      const LinearColor& color) {
  return surface == Surface::kSky ? color : environment.atmosphere.throughHaze(color, ray, u);
}

void storePixel(const Environment& environment, const Vector3& ray, Surface surface, double u,
                const LinearColor& color, std::size_t pixel, Picture& picture) {
  storeSeen(surface, u, seenColor(environment, ray, surface, u, color), pixel, picture);
}

void storeSeen(Surface surface, double u, const LinearColor& seen, std::size_t pixel, Picture& picture) {
  picture.rgb[3 * pixel] = encodeSrgb(seen.red);
  picture.rgb[3 * pixel + 1] = encodeSrgb(seen.green);
  picture.rgb[3 * pixel + 2] = encodeSrgb(seen.blue);
  picture.depth[pixel] = static_cast<float>(u);
  picture.surface[pixel] = surface;
}

}  // namespace deltaz
