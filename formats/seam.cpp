#include "formats/seam.h"

#include <cmath>

#include "formats/bytes.h"

namespace deltaz {

namespace {

constexpr std::size_t kHeaderBytes = 48;
constexpr std::size_t kRunBytes = 24, kVertexBytes = 40, kFaceBytes = 12, kReplacedBytes = 24;
constexpr std::uint32_t kTopFlag = 1;

// Whether post (column, row) is one of the grid's.
bool holdsPost(const GridHeader& grid, std::int64_t column, std::int64_t row) {
  return column >= grid.x_axis.first && column - grid.x_axis.first < grid.x_axis.count &&
         row >= grid.y_axis.first && row - grid.y_axis.first < grid.y_axis.count;
}

bool holdsCell(const GridHeader& grid, std::int64_t column, std::int64_t row) {
  return holdsPost(grid, column, row) && holdsPost(grid, column + 1, row + 1);
}

bool isWeight(double weight) {
  return weight >= 0 && weight <= 1;
}

}  // namespace

std::vector<std::byte> encodeSeam(const Seam& seam) {
  ByteWriter writer;
  writer.put(seam.upper);
  writer.put(seam.lower);
  writer.put(static_cast<std::uint32_t>(seam.runs.size()));
  writer.put(static_cast<std::uint32_t>(seam.vertices.size()));
  writer.put(static_cast<std::uint32_t>(seam.faces.size()));
  for (const auto& replaced : seam.replaced) writer.put(static_cast<std::uint32_t>(replaced.size()));
  writer.put(seam.error);
  writer.putZeros(kHeaderBytes - writer.size());
  for (const CellRun& run : seam.runs) {
    writer.put(run.row);
    writer.put(run.begin);
    writer.put(run.end);
  }
  for (const SeamVertex& vertex : seam.vertices) {
    writer.put(vertex.column);
    writer.put(vertex.row);
    writer.put(static_cast<std::uint8_t>(vertex.side));
    for (const std::int8_t step : {vertex.to_p1[0], vertex.to_p1[1], vertex.to_p2[0], vertex.to_p2[1]})
      writer.put(step);
    writer.putZeros(3);
    writer.put(vertex.weight1);
    writer.put(vertex.weight2);
  }
  for (const auto& face : seam.faces) {
    for (const std::uint32_t vertex : face) writer.put(vertex);
  }
  for (const auto& replaced : seam.replaced) {
    for (const ReplacedFace& face : replaced) {
      writer.put(face.column);
      writer.put(face.row);
      writer.put((face.face_count << 1) | (face.top ? kTopFlag : 0));
      writer.put(face.first_face);
    }
  }
  return writer.take();
}

Result<Seam> decodeSeam(std::span<const std::byte> bytes, const std::vector<GridHeader>& grids,
                        const std::string& where) {
  const auto damaged = [&](const char* why) {
    return invalidError(IssueCode::kHgtSeam, where, "the seam cannot be decoded", why);
  };
  if (bytes.size() < kHeaderBytes) return damaged("its header is cut short");
  ByteReader reader(bytes);
  Seam seam;
  seam.upper = reader.get<std::uint16_t>();
  seam.lower = reader.get<std::uint16_t>();
  const auto runs = reader.get<std::uint32_t>();
  const auto vertices = reader.get<std::uint32_t>();
  const auto faces = reader.get<std::uint32_t>();
  const std::array<std::uint32_t, 2> replaced = {reader.get<std::uint32_t>(), reader.get<std::uint32_t>()};
  seam.error = reader.get<double>();
  while (reader.position() < kHeaderBytes) {
    if (reader.get<std::uint8_t>() != 0) return damaged("a reserved byte is not zero");
  }
  if (seam.upper >= grids.size() || seam.lower >= grids.size() || seam.upper >= seam.lower)
    return damaged("its grids are not there, or not in order");
  if (!(seam.error >= 0 && seam.error <= kMaximumHeightMetres)) return damaged("its error is out of range");
  // Counts first, so that nothing is allocated for a file that is too short.
  const std::uint64_t needed = std::uint64_t{runs} * kRunBytes + std::uint64_t{vertices} * kVertexBytes +
                               std::uint64_t{faces} * kFaceBytes +
                               (std::uint64_t{replaced[0]} + replaced[1]) * kReplacedBytes;
  if (needed != reader.remaining()) return damaged("its parts do not add up to its length");

  const GridHeader& lower = grids[seam.lower];
  for (std::uint32_t k = 0; k < runs; ++k) {
    CellRun run;
    run.row = reader.get<std::int64_t>();
    run.begin = reader.get<std::int64_t>();
    run.end = reader.get<std::int64_t>();
    if (run.begin >= run.end || !holdsCell(lower, run.begin, run.row) ||
        !holdsCell(lower, run.end - 1, run.row))
      return damaged("it removes cells that are not there");
    seam.runs.push_back(run);
  }
  for (std::uint32_t k = 0; k < vertices; ++k) {
    SeamVertex vertex;
    vertex.column = reader.get<std::int64_t>();
    vertex.row = reader.get<std::int64_t>();
    const auto side = reader.get<std::uint8_t>();
    for (std::int8_t* step : {&vertex.to_p1[0], &vertex.to_p1[1], &vertex.to_p2[0], &vertex.to_p2[1]}) {
      *step = reader.get<std::int8_t>();
      if (*step < -1 || *step > 1) return damaged("a vertex lies between posts that are not neighbours");
    }
    for (int pad = 0; pad < 3; ++pad) {
      if (reader.get<std::uint8_t>() != 0) return damaged("a reserved byte is not zero");
    }
    vertex.weight1 = reader.get<double>();
    vertex.weight2 = reader.get<double>();
    if (side > 1 || !isWeight(vertex.weight1) || !isWeight(vertex.weight2))
      return damaged("a vertex has a wrong value");
    vertex.side = static_cast<SeamSide>(side);
    const GridHeader& grid = grids[vertex.side == SeamSide::kUpper ? seam.upper : seam.lower];
    if (!holdsPost(grid, vertex.column, vertex.row) ||
        !holdsPost(grid, vertex.column + vertex.to_p1[0], vertex.row + vertex.to_p1[1]) ||
        !holdsPost(grid, vertex.column + vertex.to_p2[0], vertex.row + vertex.to_p2[1]))
      return damaged("a vertex stands outside its grid");
    seam.vertices.push_back(vertex);
  }
  for (std::uint32_t k = 0; k < faces; ++k) {
    std::array<std::uint32_t, 3> face{};
    for (std::uint32_t& vertex : face) {
      vertex = reader.get<std::uint32_t>();
      if (vertex >= vertices) return damaged("a face names a vertex that is not there");
    }
    seam.faces.push_back(face);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const GridHeader& grid = grids[side == 0 ? seam.upper : seam.lower];
    for (std::uint32_t k = 0; k < replaced[side]; ++k) {
      ReplacedFace face;
      face.column = reader.get<std::int64_t>();
      face.row = reader.get<std::int64_t>();
      const auto count_and_top = reader.get<std::uint32_t>();
      face.first_face = reader.get<std::uint32_t>();
      face.top = (count_and_top & kTopFlag) != 0;
      face.face_count = count_and_top >> 1;
      if (!holdsCell(grid, face.column, face.row)) return damaged("it replaces a face that is not there");
      if (face.first_face > faces || face.face_count > faces - face.first_face)
        return damaged("it replaces a face by faces that are not there");
      seam.replaced[side].push_back(face);
    }
  }
  return seam;
}

}  // namespace deltaz
