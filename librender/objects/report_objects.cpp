#include "librender/objects/report_objects.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace deltaz {
namespace {

std::size_t postIndex(const TerrainTile& tile, int i, int j) {
  return static_cast<std::size_t>(j) * static_cast<std::size_t>(tile.columns) + static_cast<std::size_t>(i);
}

std::uint32_t cellOf(const TerrainTile& tile, int i, int j) {
  return static_cast<std::uint32_t>(j * (tile.columns - 1) + i);
}

// Indices from `first` to `last` that are global multiples of `step`, and the ends.
std::vector<int> keptPosts(int first, int last, std::int64_t global_of_0, int step) {
  std::vector<int> kept = {first};
  for (int i = first + 1; i < last; ++i) {
    if ((global_of_0 + i) % step == 0) kept.push_back(i);
  }
  kept.push_back(last);
  return kept;
}

// Where objects begin along an axis, and at the end the last post.
std::vector<int> objectBorders(std::int64_t global_of_0, int posts) {
  return keptPosts(0, posts - 1, global_of_0, kReportObjectCells);
}

bool isWhole(const TerrainTile& tile, const ReportObject& object, const std::vector<std::uint8_t>& left_out) {
  for (int j = object.first_row; j <= object.last_row; ++j) {
    for (int i = object.first_column; i <= object.last_column; ++i) {
      if (!tile.isValid(i, j)) return false;
    }
  }
  if (left_out.empty()) return true;
  for (int j = object.first_row; j < object.last_row; ++j) {
    for (int i = object.first_column; i < object.last_column; ++i) {
      const std::uint32_t identity = cellOf(tile, i, j) << 1;
      if (left_out[identity] != 0 || left_out[identity | 1] != 0) return false;
    }
  }
  return true;
}

// Of the valid posts, relative to the eye, in metres along the view's axes.
struct Sphere {
  Vector3 centre;
  double radius = -1;  // without any valid post
};

Sphere sphereOf(const TerrainTile& tile, const std::vector<Vector3>& position, const ViewTransform& view,
                const ReportObject& object) {
  const double scale = 1 / view.pixels;
  const auto metres = [&](int i, int j) {
    const Vector3& p = position[postIndex(tile, i, j)];
    return Vector3{p.x, p.y * scale, p.z * scale};
  };
  Vector3 sum;
  int count = 0;
  for (int j = object.first_row; j <= object.last_row; ++j) {
    for (int i = object.first_column; i <= object.last_column; ++i) {
      if (!tile.isValid(i, j)) continue;
      sum = sum + metres(i, j);
      ++count;
    }
  }
  if (count == 0) return {};
  Sphere sphere{sum * (1.0 / count), 0};
  double squared = 0;  // of the radius
  for (int j = object.first_row; j <= object.last_row; ++j) {
    for (int i = object.first_column; i <= object.last_column; ++i) {
      if (!tile.isValid(i, j)) continue;
      const Vector3 offset = metres(i, j) - sphere.centre;
      squared = std::max(squared, dot(offset, offset));
    }
  }
  sphere.radius = std::sqrt(squared);
  return sphere;
}

}  // namespace

ReportStep reportStep(int level) {
  return {1 << (level / 2), 1 << ((level - 1) / 2)};
}

std::vector<ReportObject> reportObjects(const TerrainTile& tile, const std::vector<Vector3>& position,
                                        const ViewTransform& view, const ReportRanges& ranges,
                                        const std::vector<std::uint8_t>& left_out) {
  std::vector<ReportObject> objects;
  if (tile.columns < 2 || tile.rows < 2) return objects;
  constexpr double kRounding = 0.01;  // metres, of the way into view space and back
  const ViewVolume volume(view);
  const std::vector<int> columns = objectBorders(tile.first_column, tile.columns);
  const std::vector<int> rows = objectBorders(tile.first_row, tile.rows);
  for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
    for (std::size_t c = 0; c + 1 < columns.size(); ++c) {
      ReportObject object{columns[c], columns[c + 1], rows[r], rows[r + 1], {}, true};
      const Sphere sphere = sphereOf(tile, position, view, object);
      const Vector3 centre = view.eye + view.forward * sphere.centre.x + view.right * sphere.centre.y +
                             view.down * sphere.centre.z;
      object.in_view = sphere.radius >= 0 && !volume.isOutside(centre, sphere.radius + kRounding);
      if (object.in_view && isWhole(tile, object, left_out)) object.levels = ranges.at(length(sphere.centre));
      objects.push_back(object);
    }
  }
  return objects;
}

TerrainFaces reportFaces(const TerrainTile& tile, const std::vector<Vector3>& position,
                         const std::vector<ReportObject>& objects, FrameStatistics::Objects& statistics,
                         const std::vector<std::uint8_t>& left_out) {
  TerrainFaces faces;
  const auto drawn = [&](std::uint32_t identity) { return left_out.empty() || left_out[identity] == 0; };
  const auto post = [&](int i, int j) { return static_cast<std::uint32_t>(postIndex(tile, i, j)); };
  for (const ReportObject& object : objects) {
    if (!object.in_view) {
      ++statistics.out_of_view;
      continue;
    }
    ++statistics.drawn;
    if (object.levels.isTwice()) ++statistics.drawn_twice;
    for (int level = object.levels.finest; level <= object.levels.coarsest; ++level) {
      const std::uint64_t before = faces.in;
      const ReportStep step = reportStep(level);
      const std::vector<int> columns =
          keptPosts(object.first_column, object.last_column, tile.first_column, step.columns);
      const std::vector<int> rows = keptPosts(object.first_row, object.last_row, tile.first_row, step.rows);
      for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
        for (std::size_t c = 0; c + 1 < columns.size(); ++c) {
          const int west = columns[c], east = columns[c + 1], south = rows[r], north = rows[r + 1];
          // Objects that are not whole are at level 1, where these are the corners of one cell.
          const std::uint32_t bottom = cellOf(tile, west, south) << 1,
                              top = cellOf(tile, west, north - 1) << 1 | 1;
          if (tile.isValid(west, south) && tile.isValid(east, south) && tile.isValid(east, north) &&
              drawn(bottom)) {
            addFace(faces, position, {{post(west, south), post(east, south), post(east, north)}, bottom});
          }
          if (tile.isValid(west, south) && tile.isValid(east, north) && tile.isValid(west, north) &&
              drawn(top)) {
            addFace(faces, position, {{post(west, south), post(east, north), post(west, north)}, top});
          }
        }
      }
      const std::uint64_t added = faces.in - before;
      if (level == object.levels.finest) {
        statistics.faces[static_cast<std::size_t>(level - 1)] += added;
      } else {
        statistics.faces_twice += added;
      }
    }
  }
  return faces;
}

TerrainFaces reportFaces(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view,
                         const ReportLod& lod, const std::vector<Vector3>& position,
                         const std::vector<std::uint8_t>& left_out, FrameStatistics::Objects& statistics) {
  const std::vector<ReportObject> objects =
      reportObjects(tile, position, view, ReportRanges(lod, view, geometry), left_out);
  return reportFaces(tile, position, objects, statistics, left_out);
}

}  // namespace deltaz
