#include "exact_rays.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace deltaz::bench {

ExactPicture traceExactly(const PeerScene& scene) {
  const ViewTransform view = scene.view();
  const auto width = static_cast<std::size_t>(scene.width);
  ExactPicture picture;
  picture.rgba.assign(width * static_cast<std::size_t>(scene.height), kPeerBackground);
  picture.covered.assign(picture.rgba.size(), 0);
  std::vector<double> nearest(picture.rgba.size(), scene.far);
  for (const auto& triangle : scene.triangles) {
    Vector3 corner[3];
    double least_j = 1e30, greatest_j = -1e30, least_i = 1e30, greatest_i = -1e30;
    bool before = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t n = triangle[k];
      corner[k] = Vector3{static_cast<double>(scene.vertices.x[n]), static_cast<double>(scene.vertices.y[n]),
                          static_cast<double>(scene.vertices.z[n])} -
                  view.eye;
      const double u = dot(view.forward, corner[k]);
      before |= u < scene.near;
      const double j = view.centre_j + view.pixels * dot(view.right, corner[k]) / u;
      const double i = view.centre_i + view.pixels * dot(view.down, corner[k]) / u;
      least_j = std::min(least_j, j);
      greatest_j = std::max(greatest_j, j);
      least_i = std::min(least_i, i);
      greatest_i = std::max(greatest_i, i);
    }
    const Vector3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double distance = dot(normal, corner[0]);
    if (!(distance < 0)) continue;  // seen from behind
    if (before) {
      // Nothing of the benchmark's scenes comes near the eye inside the picture; what lies behind it is
      // tested everywhere.
      if (std::max({dot(view.forward, corner[0]), dot(view.forward, corner[1]),
                    dot(view.forward, corner[2])}) < scene.near)
        continue;
      least_j = least_i = -1e9;
      greatest_j = greatest_i = 1e9;
    }
    const int first_j = static_cast<int>(std::clamp(std::floor(least_j), 0.0, scene.width - 1.0));
    const int last_j = static_cast<int>(std::clamp(std::ceil(greatest_j), -1.0, scene.width - 1.0));
    const int first_i = static_cast<int>(std::clamp(std::floor(least_i), 0.0, scene.height - 1.0));
    const int last_i = static_cast<int>(std::clamp(std::ceil(greatest_i), -1.0, scene.height - 1.0));
    const Vector3 edge[3] = {cross(corner[1], corner[2]), cross(corner[2], corner[0]),
                             cross(corner[0], corner[1])};
    for (int i = first_i; i <= last_i; ++i) {
      for (int j = first_j; j <= last_j; ++j) {
        const Vector3 ray = view.ray(j, i);
        // Volumes of the ray with the edges: all of one sign inside (Pluecker).
        const double weight[3] = {-dot(edge[0], ray), -dot(edge[1], ray), -dot(edge[2], ray)};
        if (weight[0] < 0 || weight[1] < 0 || weight[2] < 0) continue;
        const double facing = dot(normal, ray);
        if (!(facing < 0)) continue;
        const double u = distance / facing;
        const std::size_t pixel = static_cast<std::size_t>(i) * width + static_cast<std::size_t>(j);
        if (u < scene.near || !(u < nearest[pixel])) continue;
        nearest[pixel] = u;
        picture.covered[pixel] = 1;
        const double sum = weight[0] + weight[1] + weight[2];
        std::uint32_t color = 0xFF000000;
        for (int channel = 0; channel < 3; ++channel) {
          double value = 0;
          for (std::size_t k = 0; k < 3; ++k)
            value += static_cast<double>(scene.vertices.rgba[triangle[k]] >> (8 * channel) & 0xFF) *
                     weight[k] / sum;
          color |= static_cast<std::uint32_t>(std::clamp(value + 0.5, 0.0, 255.0)) << (8 * channel);
        }
        picture.rgba[pixel] = color;
      }
    }
  }
  return picture;
}

PictureError compareWith(const ExactPicture& exact, const std::vector<std::uint32_t>& rgba) {
  PictureError error;
  double squares = 0;
  for (std::size_t n = 0; n < rgba.size(); ++n) {
    error.coverage_mismatches += (rgba[n] != kPeerBackground) != (exact.covered[n] != 0) ? 1 : 0;
    int worst = 0;
    for (int channel = 0; channel < 3; ++channel) {
      const int off = std::abs(static_cast<int>(rgba[n] >> (8 * channel) & 0xFF) -
                               static_cast<int>(exact.rgba[n] >> (8 * channel) & 0xFF));
      worst = std::max(worst, off);
      squares += static_cast<double>(off) * off;
    }
    error.off_by_8 += worst > 8 ? 1 : 0;
  }
  error.psnr = squares == 0 ? std::numeric_limits<double>::infinity()
                            : 10 * std::log10(255.0 * 255.0 * 3 * static_cast<double>(rgba.size()) / squares);
  return error;
}

}  // namespace deltaz::bench
