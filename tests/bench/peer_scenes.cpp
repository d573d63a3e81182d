#include "peer_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "librender/raster/grid_culler.h"

namespace deltaz::bench {
namespace {

constexpr double kPi = std::numbers::pi;

// ---- deterministic noise ----

std::uint32_t latticeHash(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = (x * 0x9E3779B1U) ^ (y * 0x85EBCA77U + 0x165667B1U) ^ (seed * 0xC2B2AE3DU + 0x27D4EB2FU);
  h = (h ^ (h >> 15)) * 0x2C1B3C6DU;
  h = (h ^ (h >> 12)) * 0x297A2D39U;
  return h ^ (h >> 15);
}

double fade(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

// Gradient noise (Perlin 2002) with gradients from the hash.
double gradientNoise(double x, double y, std::uint32_t seed) {
  const double cell_x = std::floor(x), cell_y = std::floor(y);
  const double dx = x - cell_x, dy = y - cell_y;
  const auto corner = [&](int right, int up) {
    const std::uint32_t h =
        latticeHash(static_cast<std::uint32_t>(static_cast<std::int32_t>(cell_x) + right),
                    static_cast<std::uint32_t>(static_cast<std::int32_t>(cell_y) + up), seed);
    const double gradient_x = (static_cast<int>(h & 0xFFFF) - 32768) / 32768.0;
    const double gradient_y = (static_cast<int>(h >> 16) - 32768) / 32768.0;
    return gradient_x * (dx - right) + gradient_y * (dy - up);
  };
  const double a = corner(0, 0), b = corner(1, 0), c = corner(0, 1), d = corner(1, 1);
  const double across = fade(dx), upward = fade(dy);
  const double south = a + (b - a) * across, north = c + (d - c) * across;
  return south + (north - south) * upward;
}

double fractalNoise(double x, double y, int octaves, std::uint32_t seed) {
  double sum = 0, amplitude = 1, frequency = 1;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += amplitude * gradientNoise(x * frequency, y * frequency, seed + static_cast<std::uint32_t>(octave));
    amplitude *= 0.5;
    frequency *= 2;
  }
  return sum;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint32_t word() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    std::uint64_t x = state_ ^ (state_ >> 33);
    x *= 0xFF51AFD7ED558CCDULL;
    return static_cast<std::uint32_t>((x ^ (x >> 33)) >> 32);
  }
  double unit() { return word() / 4294967296.0; }

 private:
  std::uint64_t state_;
};

// ---- building ----

std::uint32_t rgb(double red, double green, double blue) {
  const auto byte = [](double v) { return static_cast<std::uint32_t>(static_cast<std::uint8_t>(v)); };
  return byte(red) | byte(green) << 8 | byte(blue) << 16 | 0xFF000000U;
}

void addVertex(PeerScene& scene, double x, double y, double z, double u, double v) {
  scene.vertices.append(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0);
  scene.texture_u.push_back(static_cast<float>(u));
  scene.texture_v.push_back(static_cast<float>(v));
}

// Colours by slope to the light and by height, then two triangles a cell.
void finishGrid(PeerScene& scene, int columns, int rows) {
  scene.grid_columns = columns;
  scene.grid_rows = rows;
  MeshVertices& v = scene.vertices;
  const auto at = [&](int i, int j) {
    return static_cast<std::size_t>(std::clamp(j, 0, rows - 1)) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(std::clamp(i, 0, columns - 1));
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const std::size_t west = at(i - 1, j), east = at(i + 1, j), south = at(i, j - 1), north = at(i, j + 1);
      // Differences in single precision, as the benchmark's own program takes them.
      const double ax = v.x[east] - v.x[west], ay = v.y[east] - v.y[west], az = v.z[east] - v.z[west];
      const double bx = v.x[north] - v.x[south], by = v.y[north] - v.y[south], bz = v.z[north] - v.z[south];
      const double nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
      const double length = std::sqrt(nx * nx + ny * ny + nz * nz);
      const double light = std::max(0.0, (nx * 0.5 + ny * -0.3 + nz * 0.81) / length) * 0.85 + 0.15;
      const double e = std::clamp((static_cast<double>(v.z[at(i, j)]) + 600) / 1600.0, 0.0, 1.0);
      v.rgba[at(i, j)] = rgb(255 * light * (0.35 + 0.6 * e), 255 * light * (0.55 + 0.35 * e),
                             255 * light * (0.25 + 0.7 * e * e));
    }
  }
  const auto across = static_cast<std::uint32_t>(columns);
  for (std::uint32_t j = 0; j + 1 < static_cast<std::uint32_t>(rows); ++j) {
    for (std::uint32_t i = 0; i + 1 < across; ++i) {
      const std::uint32_t south_west = j * across + i, north_west = south_west + across;
      scene.triangles.push_back({south_west, south_west + 1, north_west + 1});
      scene.triangles.push_back({south_west, north_west + 1, north_west});
    }
  }
}

void setCamera(PeerScene& scene, std::array<double, 3> eye, double pitch_degrees, double near, double far) {
  const double pitch = pitch_degrees * kPi / 180;
  scene.eye = eye;
  scene.forward = {0, std::cos(pitch), std::sin(pitch)};
  scene.right = {1, 0, 0};
  scene.up = {0, -std::sin(pitch), std::cos(pitch)};
  scene.near = near;
  scene.far = far;
}

void makeTerrain(PeerScene& scene) {
  constexpr int kPosts = 1025;
  constexpr double kSpacing = 30;
  const auto height = [](int i, int j) {
    return 900.0 * fractalNoise(i * kSpacing / 8000.0 + 11.3, j * kSpacing / 8000.0 + 5.7, 9, 1983);
  };
  for (int j = 0; j < kPosts; ++j) {
    for (int i = 0; i < kPosts; ++i) {
      const auto x = static_cast<float>(i * kSpacing), y = static_cast<float>(j * kSpacing);
      addVertex(scene, i * kSpacing, j * kSpacing, height(i, j), static_cast<double>(x / 1000),
                static_cast<double>(y / 1000));
    }
  }
  finishGrid(scene, kPosts, kPosts);
  setCamera(scene, {512 * kSpacing, 10 * kSpacing, height(512, 10) + 300}, -8, 10, 60000);
}

void addGlobe(PeerScene& scene, double x, double y, double z, double radius) {
  constexpr int kMeridians = 15, kParallels = 11;
  const auto base = static_cast<std::uint32_t>(scene.vertices.x.size());
  for (int a = 0; a <= kParallels; ++a) {
    for (int l = 0; l <= kMeridians; ++l) {
      const double latitude = kPi * a / kParallels - kPi / 2, longitude = 2 * kPi * l / kMeridians;
      const double nx = std::cos(latitude) * std::cos(longitude),
                   ny = std::cos(latitude) * std::sin(longitude);
      const double nz = std::sin(latitude);
      addVertex(scene, x + radius * nx, y + radius * ny, z + radius * nz,
                static_cast<double>(static_cast<float>(l) / 15.0F),
                static_cast<double>(static_cast<float>(a) / 11.0F));
      const double light = std::max(0.0, nx * 0.5 - ny * 0.3 + nz * 0.81) * 0.8 + 0.2;
      scene.vertices.rgba.back() = rgb(250 * light, 120 * light, 60 * light);
    }
  }
  for (std::uint32_t a = 0; a < kParallels; ++a) {
    for (std::uint32_t l = 0; l < kMeridians; ++l) {
      const std::uint32_t p = base + a * (kMeridians + 1) + l, above = p + kMeridians + 1;
      if (a > 0) scene.triangles.push_back({p, p + 1, above + 1});
      if (a + 1 < kParallels) scene.triangles.push_back({p, above + 1, above});
    }
  }
}

void makeReportScene(PeerScene& scene) {
  constexpr int kAcross = 101, kAway = 106;
  constexpr double kNearest = 300, kFarthest = 20000;
  const double half_angle = std::tan(16 * kPi / 180);
  for (int j = 0; j < kAway; ++j) {
    for (int i = 0; i < kAcross; ++i) {
      const double d = kNearest * std::pow(kFarthest / kNearest, j / static_cast<double>(kAway - 1));
      const double x = (2.0 * i / (kAcross - 1) - 1) * d * half_angle * 1.05;
      const double z = std::min(1.0, d / 4000) * 350 * fractalNoise(x / 6000 + 3.1, d / 6000 + 7.9, 7, 77);
      addVertex(scene, x, d, z, static_cast<double>(static_cast<float>(x) / 250),
                static_cast<double>(static_cast<float>(d) / 250));
    }
  }
  finishGrid(scene, kAcross, kAway);
  Random random(25);
  for (int model = 0; model < 12; ++model) {
    const double d = 600 + 350 * model;
    const double x = (random.unit() * 1.6 - 0.8) * d * half_angle;
    const double radius = 20 + 25 * random.unit();
    const double z = 20 + 80 * random.unit();
    addGlobe(scene, x, d, z, radius);
  }
  setCamera(scene, {0, 0, 150}, -6, 5, 40000);
}

void makeRandomTriangles(PeerScene& scene, bool small, double complexity) {
  const double area = small ? 10 : 1000;
  const auto count = static_cast<std::size_t>(complexity * scene.width * scene.height / area + 0.5);
  setCamera(scene, {0, 0, 0}, 0, 1, 2000);
  const double tangent = std::tan(16 * kPi / 180);
  Random random(4242);
  for (std::size_t n = 0; n < count; ++n) {
    const double centre_x = random.unit() * scene.width, centre_y = random.unit() * scene.height;
    const double wanted = area * (0.5 + random.unit());
    const double turn = random.unit() * 2 * kPi;
    double x[3], y[3];
    for (int k = 0; k < 3; ++k) {
      const double angle = turn + k * 2 * kPi / 3 + (random.unit() - 0.5) * 0.8;
      const double radius = 0.6 + 0.4 * random.unit();
      x[k] = radius * std::cos(angle);
      y[k] = radius * std::sin(angle);
    }
    const double own = 0.5 * ((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]));
    const double scale = std::sqrt(wanted / own);
    const double depth = 10 * std::pow(100.0, random.unit());
    const std::uint32_t hash = random.word();
    for (int k = 0; k < 3; ++k) {
      const double screen_x = centre_x + scale * x[k], screen_y = centre_y + scale * y[k];
      const double w = depth * (0.97 + 0.06 * random.unit());
      const double nx = 2 * screen_x / scene.width - 1, ny = 2 * screen_y / scene.height - 1;
      addVertex(scene, nx * w * tangent, w, ny * w * tangent * scene.height / scene.width, screen_x / 64,
                screen_y / 64);
      scene.vertices.rgba.back() = latticeHash(hash, static_cast<std::uint32_t>(k), 9) | 0xFF000000U;
    }
    const auto first = static_cast<std::uint32_t>(3 * n);
    scene.triangles.push_back({first, first + 1, first + 2});
  }
}

}  // namespace

ViewTransform PeerScene::view() const {
  ViewTransform transform;
  transform.eye = {eye[0], eye[1], eye[2]};
  transform.forward = {forward[0], forward[1], forward[2]};
  transform.right = {right[0], right[1], right[2]};
  transform.down = {-up[0], -up[1], -up[2]};
  transform.width = width;
  transform.height = height;
  transform.pixels = width / 2.0 / std::tan(field_of_view * kPi / 360);
  transform.centre_j = (width - 1) / 2.0;
  transform.centre_i = (height - 1) / 2.0;
  return transform;
}

std::array<float, 16> PeerScene::clipMatrix() const {
  const double x_scale = 1 / std::tan(field_of_view * kPi / 360);
  const double y_scale = static_cast<double>(width) / height * x_scale;
  const double a = (far + near) / (far - near), b = -2 * far * near / (far - near);
  const auto with_eye = [&](const std::array<double, 3>& axis) {
    return axis[0] * eye[0] + axis[1] * eye[1] + axis[2] * eye[2];
  };
  std::array<float, 16> m{};
  for (std::size_t j = 0; j < 3; ++j) {
    m[j * 4] = static_cast<float>(x_scale * right[j]);
    m[j * 4 + 1] = static_cast<float>(y_scale * up[j]);
    m[j * 4 + 2] = static_cast<float>(a * forward[j]);
    m[j * 4 + 3] = static_cast<float>(forward[j]);
  }
  m[12] = static_cast<float>(-x_scale * with_eye(right));
  m[13] = static_cast<float>(-y_scale * with_eye(up));
  m[14] = static_cast<float>(-a * with_eye(forward) + b);
  m[15] = static_cast<float>(-with_eye(forward));
  return m;
}

std::vector<GridMesh> PeerScene::grids() const {
  std::vector<GridMesh> result;
  if (grid_columns == 0) return result;
  GridMesh& grid = result.emplace_back();
  grid.columns = grid_columns;
  grid.rows = grid_rows;
  const auto count = static_cast<std::ptrdiff_t>(grid_columns) * grid_rows;
  grid.vertices.x.assign(vertices.x.begin(), vertices.x.begin() + count);
  grid.vertices.y.assign(vertices.y.begin(), vertices.y.begin() + count);
  grid.vertices.z.assign(vertices.z.begin(), vertices.z.begin() + count);
  grid.vertices.rgba.assign(vertices.rgba.begin(), vertices.rgba.begin() + count);
  grid.vertices.pad();
  return result;
}

std::vector<IndexedMesh> PeerScene::meshes() const {
  const std::size_t in_grid = grid_columns == 0 ? 0
                                                : 2 * static_cast<std::size_t>(grid_columns - 1) *
                                                      static_cast<std::size_t>(grid_rows - 1);
  std::vector<IndexedMesh> result;
  if (in_grid < triangles.size()) result.emplace_back(vertices, std::span(triangles).subspan(in_grid));
  return result;
}

std::vector<std::uint32_t> peerTexture() {
  std::vector<std::uint32_t> texels;
  texels.reserve(std::size_t{kPeerTextureSide} * kPeerTextureSide);
  for (std::uint32_t y = 0; y < kPeerTextureSide; ++y) {
    for (std::uint32_t x = 0; x < kPeerTextureSide; ++x) {
      const std::uint32_t grey = 128 + (latticeHash(x >> 2, y >> 2, 5) & 63) + (latticeHash(x, y, 6) & 63);
      texels.push_back(grey | grey << 8 | (grey - 20) << 16 | 0xFF000000U);
    }
  }
  return texels;
}

PeerScene makePeerScene(std::string_view name, int width, int height) {
  PeerScene scene;
  scene.name = name;
  scene.width = width;
  scene.height = height;
  if (name == "A") {
    makeTerrain(scene);
  } else if (name == "B") {
    makeReportScene(scene);
  } else {
    const std::size_t last_dash = name.rfind('-');
    makeRandomTriangles(scene, name.find("small") != std::string_view::npos,
                        std::atof(std::string(name.substr(last_dash + 1)).c_str()));
  }
  return scene;
}

}  // namespace deltaz::bench
