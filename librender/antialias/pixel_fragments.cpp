#include "librender/antialias/pixel_fragments.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace deltaz {
namespace {

double planeAt(const FaceLanes& face, double j, double i) {
  return face.value[kInverseU] +
         (face.per_j[kInverseU] * (j - face.anchor_j) + face.per_i[kInverseU] * (i - face.anchor_i));
}

}  // namespace

FragmentGatherer::FragmentGatherer(const Environment& environment, const Sampling& sampling)
    : environment_(environment),
      grid_(sampling),
      across_(grid_.across()),
      count_(static_cast<std::size_t>(sampling.count)),
      all_(sampling.count == kMost ? ~std::uint64_t{0} : (std::uint64_t{1} << sampling.count) - 1),
      places_(samplePlaces(sampling.count, sampling.pattern)) {
  // Pixels lie within blocks, or are whole blocks.
  static_assert(kBlockSide % 2 == 0 && kTileSide % 8 == 0);
  for (int s = 0; s < sampling.count; ++s) {
    to_grid_[static_cast<std::size_t>(s) + 1] = across_ / (256.0 * (s + 1));
    index_[static_cast<std::size_t>(s)] = static_cast<std::uint16_t>(tileIndex(s % across_, s / across_));
  }
}

void FragmentGatherer::enter(const SettledTile& tile, std::span<const FaceLanes> faces, int tile_j,
                             int tile_i) {
  tile_ = &tile;
  faces_ = faces;
  first_j_ = tile_j * kTileSide;
  first_i_ = tile_i * kTileSide;
  sea_of_tile_ = seaCover(environment_.sea.terms(), environment_.view, first_j_ - 0.5, first_i_ - 0.5,
                          first_j_ + kTileSide - 0.5, first_i_ + kTileSide - 0.5);
  faces_are_nearer_ = false;
  if (sea_of_tile_ != SeaCover::kEverywhere) return;
  constexpr double kHalf = kTileSide / 2.0;
  const SeaBound bound =
      seaBound(environment_.sea.terms(), environment_.view, first_j_ + kHalf - 0.5, first_i_ + kHalf - 0.5);
  const double nearest_sea = bound.value + (std::abs(bound.per_j) + std::abs(bound.per_i)) * kHalf;
  faces_are_nearer_ = std::all_of(faces_.begin(), faces_.end(),
                                  [&](const FaceLanes& face) { return face.least > nearest_sea; });
}

void FragmentGatherer::enterRow(int first_i) {
  const SeaTerms& sea = environment_.sea.terms();
  sea_ = sea_of_tile_;
  if (sea_ == SeaCover::kPartly) {
    sea_ = seaCover(sea, environment_.view, first_j_ - 0.5, first_i - 0.5, first_j_ + kTileSide - 0.5,
                    first_i + across_ - 0.5);
  }
  if (sea_ == SeaCover::kEverywhere && !faces_are_nearer_) {
    bound_ =
        seaBound(sea, environment_.view, first_j_ + (kTileSide - 1) / 2.0, first_i + (across_ - 1) / 2.0);
  }
}

bool FragmentGatherer::isBeforeSea(const FaceLanes& face, double j, double i) const {
  const double half = across_ / 2.0, sea = bound_.at(j, i);
  // No sample of a face is farther than its farthest vertex.
  if (face.least > sea + (std::abs(bound_.per_j) + std::abs(bound_.per_i)) * half) return true;
  const double change =
      std::abs(face.per_j[kInverseU] - bound_.per_j) + std::abs(face.per_i[kInverseU] - bound_.per_i);
  return planeAt(face, j, i) - sea > change * half;
}

void FragmentGatherer::meetSea(int first_j, int first_i) {
  alignas(64) double x[kMost + kVectorPadding], y[kMost + kVectorPadding], z[kMost + kVectorPadding];
  alignas(64) double sea_u[kMost + kVectorPadding];
  std::array<double, kMost> at_j, at_i;
  for (std::size_t s = 0; s < count_; ++s) {
    const int j = first_j + static_cast<int>(s) % across_, i = first_i + static_cast<int>(s) / across_;
    at_j[s] = grid_.placeJ(j, i);
    at_i[s] = grid_.placeI(j, i);
    const Vector3 ray = environment_.view.ray(at_j[s], at_i[s]);
    x[s] = ray.x;
    y[s] = ray.y;
    z[s] = ray.z;
  }
  for (std::size_t s = count_; s < count_ + kVectorPadding; ++s) x[s] = y[s] = z[s] = 0;
  environment_.sea.depths({x, y, z, count_}, sea_u);
  for (std::size_t s = 0; s < count_; ++s) {
    const bool sea = sea_u[s] < std::numeric_limits<double>::infinity();
    if (owner_[s] >= kSea) {
      owner_[s] = sea ? kSea : kSky;
    } else if (sea) {
      const FaceLanes& face = faces_[owner_[s]];
      const double inverse_u = std::min(std::max(planeAt(face, at_j[s], at_i[s]), face.least), face.greatest);
      if (!(1 / inverse_u <= sea_u[s])) owner_[s] = kSea;
    }
  }
}

void FragmentGatherer::append(int column, int first_j, int first_i, std::vector<Fragment>& fragments) const {
  const double centre_j = first_j + (across_ - 1) / 2.0, centre_i = first_i + (across_ - 1) / 2.0;
  for (std::uint64_t left = all_; left != 0;) {
    const Owner owner = owner_[static_cast<std::size_t>(std::countr_zero(left))];
    std::uint64_t samples = 0;
    std::int32_t x = 0, y = 0;
    std::uint32_t count = 0;
    for (std::uint64_t rest = left; rest != 0; rest &= rest - 1) {
      const auto s = static_cast<std::size_t>(std::countr_zero(rest));
      // Without a branch: neighbours differ as often as not.
      const std::uint32_t mine = owner_[s] == owner ? 1 : 0;
      samples |= std::uint64_t{mine} << s;
      count += mine;
      x += places_[s].x * static_cast<std::int32_t>(mine);
      y += places_[s].y * static_cast<std::int32_t>(mine);
    }
    left &= ~samples;
    const double to_grid = to_grid_[count];
    fragments.push_back({column, count, samples, owner >= kSea ? nullptr : &faces_[owner],
                         centre_j + x * to_grid, centre_i + y * to_grid});
  }
}

std::uint64_t FragmentGatherer::gatherRow(int row, int columns, std::vector<Fragment>& fragments) {
  const int first_i = first_i_ + row * across_;
  const double to_centre = (across_ - 1) / 2.0, centre_i = first_i + to_centre;
  enterRow(first_i);
  const std::uint32_t* const owners = tile_->owners().empty() ? nullptr : tile_->owners().data();
  std::uint64_t covered = 0;
  for (int column = 0; column < columns; ++column) {
    const int first_j = first_j_ + column * across_;
    const double centre_j = first_j + to_centre;
    // What the first sample shows, and whether all of them show it.
    Owner first = kNoTriangle;
    bool same = true;
    if (owners != nullptr) {
      const std::uint32_t* const of_pixel = owners + tileIndex(column * across_, row * across_);
      first = of_pixel[0];
      std::uint32_t differing = 0;
      for (std::size_t s = 1; s < count_; ++s) differing |= of_pixel[index_[s]] ^ first;
      same = differing == 0;
      if (!same) {
        for (std::size_t s = 0; s < count_; ++s) {
          owner_[s] = of_pixel[index_[s]];
          covered += owner_[s] == kNoTriangle ? 0 : 1;
        }
      }
    }
    if (same) covered += first == kNoTriangle ? 0 : count_;

    bool by_sample = sea_ == SeaCover::kPartly;
    if (sea_ == SeaCover::kEverywhere) {
      const auto before_sea = [&](Owner& owner) {
        if (owner != kNoTriangle) return faces_are_nearer_ || isBeforeSea(faces_[owner], centre_j, centre_i);
        owner = kSea;
        return true;
      };
      if (same) {
        by_sample = !before_sea(first);
      } else {
        for (std::size_t s = 0; s < count_; ++s) by_sample = !before_sea(owner_[s]) || by_sample;
      }
    }
    if (by_sample) {
      if (same) std::fill_n(owner_.begin(), count_, first);
      meetSea(first_j, first_i);
      first = owner_[0];
      same = std::all_of(owner_.begin(), owner_.begin() + static_cast<std::ptrdiff_t>(count_),
                         [&](Owner owner) { return owner == first; });
    }
    if (same) {
      fragments.push_back({column, static_cast<std::uint32_t>(count_), all_,
                           first >= kSea ? nullptr : &faces_[first], centre_j, centre_i});
    } else {
      append(column, first_j, first_i, fragments);
    }
  }
  return covered;
}

}  // namespace deltaz
