#include "librender/scene/camera.h"

#include <GeographicLib/Math.hpp>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "librender/scene/view_volume.h"

namespace deltaz {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;

// East, north and up (unit vectors, Earth-centred) of the local frame at a geodetic position.
struct LocalFrame {
  Vector3 east, north, up;
};

LocalFrame localFrame(double latitude, double longitude) {
  double sin_lat = 0, cos_lat = 1, sin_lon = 0, cos_lon = 1;
  GeographicLib::Math::sincosd(latitude, sin_lat, cos_lat);
  GeographicLib::Math::sincosd(longitude, sin_lon, cos_lon);
  return {{-sin_lon, cos_lon, 0},
          {-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat},
          {cos_lat * cos_lon, cos_lat * sin_lon, sin_lat}};
}

// What must be in the default picture: corners, edge midpoints and centre of the area's bounds, at both
// heights.
std::vector<Vector3> outline(const AreaHeader& area, const EllipsoidShape& ellipsoid) {
  std::vector<Vector3> points;
  for (const double height : {area.lowest_height, area.highest_height}) {
    for (int y = 0; y <= 2; ++y) {
      for (int x = 0; x <= 2; ++x) {
        const double latitude = area.south + (area.north - area.south) * y / 2;
        const double longitude = area.west + (area.east - area.west) * x / 2;
        points.push_back(toEarthCentred(ellipsoid, {latitude, longitude, height}));
      }
    }
  }
  return points;
}

// How much of the picture's half width or height the points take; the vertical extent is taken from its own
// middle.
struct Extent {
  bool in_front = true;
  double across = 0;                        // largest |V/U|, pixels
  double lowest = -1e300, highest = 1e300;  // extremes of W/U, pixels (down positive)
};

Extent extentOf(const ViewTransform& view, const std::vector<Vector3>& points) {
  Extent extent;
  for (const Vector3& point : points) {
    const Vector3 p = view.toView(point);
    if (p.x <= kHither) return {false, 0, 0, 0};
    extent.across = std::max(extent.across, std::abs(p.y / p.x));
    extent.lowest = std::max(extent.lowest, p.z / p.x);
    extent.highest = std::min(extent.highest, p.z / p.x);
  }
  return extent;
}

}  // namespace

ViewTransform makeViewTransform(const Camera& camera, const EllipsoidShape& ellipsoid) {
  using GeographicLib::Math;
  const LocalFrame frame = localFrame(camera.eye.latitude, camera.eye.longitude);
  double sin_heading = 0, cos_heading = 1, sin_pitch = 0, cos_pitch = 1, sin_roll = 0, cos_roll = 1;
  Math::sincosd(camera.heading, sin_heading, cos_heading);
  Math::sincosd(camera.pitch, sin_pitch, cos_pitch);
  Math::sincosd(camera.roll, sin_roll, cos_roll);

  ViewTransform view;
  view.eye = toEarthCentred(ellipsoid, camera.eye);
  view.forward = (frame.east * sin_heading + frame.north * cos_heading) * cos_pitch + frame.up * sin_pitch;
  const Vector3 level_right = frame.east * cos_heading - frame.north * sin_heading;
  const Vector3 level_down = cross(view.forward, level_right);
  // Right wing down: the right vector turns towards down.
  view.right = level_right * cos_roll + level_down * sin_roll;
  view.down = level_down * cos_roll - level_right * sin_roll;
  view.width = camera.width;
  view.height = camera.height;
  view.pixels = camera.width / 2.0 / std::tan(camera.field_of_view / 2 * kRadian);
  view.centre_j = (camera.width - 1) / 2.0;
  view.centre_i = (camera.height - 1) / 2.0;
  return view;
}

Camera wholeAreaCamera(const AreaHeader& area, int width, int height, double field_of_view) {
  constexpr double kMargin = 0.96;  // of the half width or height may be used
  constexpr double kPitch = -40;    // degrees, at the centre of the area
  constexpr int kBisections = 48;
  const EllipsoidShape ellipsoid = area.grids.empty() ? EllipsoidShape{} : area.grids.front().ellipsoid;
  const std::vector<Vector3> points = outline(area, ellipsoid);
  const GeodeticPoint centre{(area.south + area.north) / 2, (area.west + area.east) / 2,
                             (area.lowest_height + area.highest_height) / 2};
  const LocalFrame frame = localFrame(centre.latitude, centre.longitude);
  const Vector3 target = toEarthCentred(ellipsoid, centre);
  const Vector3 backward = frame.up * std::sin(-kPitch * kRadian) - frame.north * std::cos(-kPitch * kRadian);

  // The camera at `distance` from the centre whose pitch puts the outline in the middle of the picture's
  // height. `fits` says whether the outline is inside the margin.
  const auto camera_at = [&](double distance, bool& fits) {
    const Vector3 eye = target + backward * distance;
    Camera camera;
    camera.eye = toGeodetic(ellipsoid, eye);
    const LocalFrame at_eye = localFrame(camera.eye.latitude, camera.eye.longitude);
    camera.heading = std::atan2(-dot(backward, at_eye.east), -dot(backward, at_eye.north)) / kRadian;
    camera.width = width;
    camera.height = height;
    camera.field_of_view = field_of_view;
    const double pitch = std::asin(std::clamp(-dot(backward, at_eye.up), -1.0, 1.0)) / kRadian;
    double low = std::max(-90.0, pitch - 30), high = pitch + 30;
    Extent extent;
    for (int step = 0; step < kBisections; ++step) {
      camera.pitch = (low + high) / 2;
      extent = extentOf(makeViewTransform(camera, ellipsoid), points);
      if (!extent.in_front) break;
      // Too much below the middle: look further down.
      (extent.lowest + extent.highest > 0 ? high : low) = camera.pitch;
    }
    fits = extent.in_front && extent.across <= kMargin * width / 2 && extent.lowest <= kMargin * height / 2 &&
           -extent.highest <= kMargin * height / 2;
    return camera;
  };

  bool fits = false;
  double near = 0, far = 1;
  Camera camera = camera_at(far, fits);
  for (int doubling = 0; doubling < 40 && !fits; ++doubling) {
    near = far;
    far *= 2;
    camera = camera_at(far, fits);
  }
  for (int step = 0; step < kBisections && far - near > 1e-3; ++step) {
    const double middle = (near + far) / 2;
    const Camera candidate = camera_at(middle, fits);
    if (fits) camera = candidate;
    (fits ? far : near) = middle;
  }
  return camera;
}

}  // namespace deltaz
