#include "peers.h"

#ifdef DELTAZ_HAVE_EMBREE

#include <algorithm>
#include <chrono>
#include <cmath>
#include <embree3/rtcore.h>
#include <numbers>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <xmmintrin.h>

namespace deltaz::bench {
namespace {

class Embree : public Peer {
 public:
  Embree(const PeerScene& scene, int threads)
      : scene_(scene),
        arena_(threads),
        pixels_(static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height)),
        depth_(pixels_.size()) {
    const std::string setting = "threads=" + std::to_string(threads);
    device_ = rtcNewDevice(setting.c_str());
    if (device_ == nullptr) return;
    const auto begin = std::chrono::steady_clock::now();
    world_ = rtcNewScene(device_);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t count = scene.vertices.x.size();
    auto* const vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, count));
    for (std::size_t n = 0; n < count; ++n) {
      vertices[3 * n] = scene.vertices.x[n];
      vertices[3 * n + 1] = scene.vertices.y[n];
      vertices[3 * n + 2] = scene.vertices.z[n];
    }
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, scene.triangles.data(),
                               0, 12, scene.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(world_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(world_);
    preparation_ =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  }
  ~Embree() override {
    if (world_ != nullptr) rtcReleaseScene(world_);
    if (device_ != nullptr) rtcReleaseDevice(device_);
  }
  bool works() const { return device_ != nullptr; }
  std::string name() const override { return "Embree ray16"; }
  double preparation() const override { return preparation_; }
  std::vector<std::uint32_t> picture() override { return pixels_; }

  void frame() override {
    constexpr int kSquare = 16;
    const int across = (scene_.width + kSquare - 1) / kSquare, down = (scene_.height + kSquare - 1) / kSquare;
    arena_.execute([&] {
      tbb::parallel_for(0, across * down, [&](int square) {
        _mm_setcsr(_mm_getcsr() | 0x8040);  // flush denormals, as Embree asks for
        const int j = square % across * kSquare, i = square / across * kSquare;
        for (int y = i; y < std::min(scene_.height, i + kSquare); y += 4) {
          for (int x = j; x < std::min(scene_.width, j + kSquare); x += 4) tracePacket(x, y);
        }
      });
    });
  }

 private:
  void tracePacket(int first_x, int first_y) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    const double tangent = std::tan(scene_.field_of_view * std::numbers::pi / 360);
    alignas(64) RTCRayHit16 rays;
    alignas(64) int valid[16];
    for (int n = 0; n < 16; ++n) {
      const int x = first_x + n % 4, y = first_y + n / 4;
      valid[n] = x < scene_.width && y < scene_.height ? -1 : 0;
      const auto across = static_cast<float>(tangent) *
                          (2 * (static_cast<float>(x) + 0.5F) / static_cast<float>(scene_.width) - 1);
      const auto upward = static_cast<float>(tangent * scene_.height / scene_.width) *
                          (1 - 2 * (static_cast<float>(y) + 0.5F) / static_cast<float>(scene_.height));
      const auto along = [&](std::size_t k) {
        return static_cast<float>(scene_.forward[k]) + across * static_cast<float>(scene_.right[k]) +
               upward * static_cast<float>(scene_.up[k]);
      };
      rays.ray.org_x[n] = static_cast<float>(scene_.eye[0]);
      rays.ray.org_y[n] = static_cast<float>(scene_.eye[1]);
      rays.ray.org_z[n] = static_cast<float>(scene_.eye[2]);
      rays.ray.dir_x[n] = along(0);
      rays.ray.dir_y[n] = along(1);
      rays.ray.dir_z[n] = along(2);
      rays.ray.tnear[n] = static_cast<float>(scene_.near);
      rays.ray.tfar[n] = static_cast<float>(scene_.far);
      rays.ray.mask[n] = 0xFFFFFFFF;
      rays.ray.flags[n] = 0;
      rays.ray.time[n] = 0;
      rays.hit.geomID[n] = RTC_INVALID_GEOMETRY_ID;
      rays.hit.instID[0][n] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid, world_, &context, &rays);
    for (int n = 0; n < 16; ++n) {
      if (valid[n] == 0) continue;
      const auto pixel = static_cast<std::size_t>(first_y + n / 4) * static_cast<std::size_t>(scene_.width) +
                         static_cast<std::size_t>(first_x + n % 4);
      depth_[pixel] = rays.ray.tfar[n];
      pixels_[pixel] = kPeerBackground;
      if (rays.hit.geomID[n] == RTC_INVALID_GEOMETRY_ID) continue;
      const auto& triangle = scene_.triangles[rays.hit.primID[n]];
      const float u = rays.hit.u[n], v = rays.hit.v[n], w = 1 - u - v;
      std::uint32_t color = 0xFF000000;
      for (int channel = 0; channel < 3; ++channel) {
        const auto value = [&](std::size_t k) {
          return static_cast<float>(scene_.vertices.rgba[triangle[k]] >> (8 * channel) & 0xFF);
        };
        color |= static_cast<std::uint32_t>(w * value(0) + u * value(1) + v * value(2) + 0.5F)
                 << (8 * channel);
      }
      pixels_[pixel] = color;
    }
  }

  const PeerScene& scene_;
  tbb::task_arena arena_;
  RTCDevice device_ = nullptr;
  RTCScene world_ = nullptr;
  double preparation_ = 0;
  std::vector<std::uint32_t> pixels_;
  std::vector<float> depth_;
};

}  // namespace

std::unique_ptr<Peer> makeEmbree(const PeerScene& scene, int threads) {
  auto peer = std::make_unique<Embree>(scene, threads);
  if (!peer->works()) return nullptr;
  return peer;
}

}  // namespace deltaz::bench

#else

namespace deltaz::bench {

std::unique_ptr<Peer> makeEmbree(const PeerScene&, int) {
  return nullptr;
}

}  // namespace deltaz::bench

#endif
