#include "libdb/source/mesh_texture.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <memory>

#include "libdb/source/gdal_session.h"

namespace deltaz {

namespace {

constexpr int kMostSide = 1 << 15;

struct MemoryFile {
  std::string name;
  ~MemoryFile() { VSIUnlink(name.c_str()); }
};

// A cell of a repeated picture.
int wrapped(double coordinate, int size) {
  const double part = coordinate - std::floor(coordinate);
  return std::clamp(static_cast<int>(part * size), 0, size - 1);
}

}  // namespace

Result<MeshTexture> MeshTexture::decode(std::span<const std::byte> bytes, const std::string& where) {
  const GdalSession session;
  static std::atomic<int> number{0};
  const MemoryFile file{fmt::format("/vsimem/deltaz-texture-{}", number++)};
  const auto refused = [&](const std::string& why) {
    return invalidError(IssueCode::kNone, where, "the texture cannot be read", why);
  };
  // GDAL only reads from the buffer.
  auto* data = static_cast<GByte*>(const_cast<void*>(static_cast<const void*>(bytes.data())));
  VSILFILE* made = VSIFileFromMemBuffer(file.name.c_str(), data, bytes.size(), FALSE);
  if (made == nullptr) return refused(session.lastFailure());
  VSIFCloseL(made);
  const char* const drivers[] = {"PNG", "JPEG", "WEBP", "BMP", "GIF", "GTiff", nullptr};
  const std::unique_ptr<GDALDataset> dataset(
      GDALDataset::Open(file.name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers));
  if (!dataset) return refused(session.lastFailure());
  MeshTexture texture;
  texture.width_ = dataset->GetRasterXSize();
  texture.height_ = dataset->GetRasterYSize();
  const int bands = dataset->GetRasterCount();
  if (bands < 1 || texture.width_ < 1 || texture.height_ < 1 || texture.width_ > kMostSide ||
      texture.height_ > kMostSide)
    return refused("it is empty or too large");
  const auto texels = static_cast<std::size_t>(texture.width_) * static_cast<std::size_t>(texture.height_);
  texture.codes_.resize(texels * 3);
  GDALRasterBand* first = dataset->GetRasterBand(1);
  const GDALColorTable* palette = first->GetColorTable();
  for (int band = 0; band < 3; ++band) {
    const int source = bands >= 3 ? band + 1 : 1;
    if (dataset->GetRasterBand(source)->RasterIO(
            GF_Read, 0, 0, texture.width_, texture.height_, texture.codes_.data() + band, texture.width_,
            texture.height_, GDT_Byte, 3, static_cast<GSpacing>(3) * texture.width_, nullptr) != CE_None)
      return refused(session.lastFailure());
  }
  // Sixteen bits a channel arrive clamped; such pictures are rare enough to be refused.
  if (first->GetRasterDataType() != GDT_Byte) return refused("it has not eight bits a channel");
  for (std::size_t t = 0; palette != nullptr && bands == 1 && t < texels; ++t) {
    GDALColorEntry entry{};
    palette->GetColorEntryAsRGB(texture.codes_[3 * t], &entry);
    texture.codes_[3 * t] = static_cast<std::uint8_t>(entry.c1);
    texture.codes_[3 * t + 1] = static_cast<std::uint8_t>(entry.c2);
    texture.codes_[3 * t + 2] = static_cast<std::uint8_t>(entry.c3);
  }
  return texture;
}

LinearColor MeshTexture::texel(double u, double v) const {
  const int column = wrapped(u, width_), row = wrapped(1 - v, height_);
  const std::size_t at = 3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(column));
  return {decodeSrgb(codes_[at]), decodeSrgb(codes_[at + 1]), decodeSrgb(codes_[at + 2])};
}

LinearColor MeshTexture::mean(const std::array<std::array<double, 2>, 3>& corners) const {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& a = corners[k];
    const auto& b = corners[(k + 1) % 3];
    longest = std::max({longest, std::abs(a[0] - b[0]) * width_, std::abs(a[1] - b[1]) * height_});
  }
  // As many equal small triangles as make each about half a texel wide; their middles are asked.
  const int steps =
      static_cast<int>(std::clamp(std::ceil(2 * longest), 1.0, static_cast<double>(kMostSteps)));
  LinearColor sum;
  int count = 0;
  const auto add = [&](double i, double j) {
    const double s = i / steps, t = j / steps, r = 1 - s - t;
    sum = sum + texel(corners[0][0] * r + corners[1][0] * s + corners[2][0] * t,
                      corners[0][1] * r + corners[1][1] * s + corners[2][1] * t);
    ++count;
  };
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; i + j < steps; ++j) {
      add(i + 1.0 / 3, j + 1.0 / 3);
      if (i + j + 1 < steps) add(i + 2.0 / 3, j + 2.0 / 3);
    }
  }
  return sum * (1.0 / count);
}

}  // namespace deltaz
