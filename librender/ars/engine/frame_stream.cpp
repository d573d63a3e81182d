#include "librender/ars/engine/frame_stream.h"

#include <algorithm>
#include <cstddef>

#include "librender/ars/engine/sub_image_bins.h"
#include "librender/ars/tiler/triangle_encoder.h"
#include "librender/ars/words/pixel_packet.h"
#include "librender/scene/view_volume.h"

namespace deltaz::ars {

namespace {

// What a pass draws of a colour: one of its three primaries, or its brightness.
double primary(const std::array<double, kColors>& color, int passes, int pass) {
  // Weights of the luma of ITU-R BT.601, as monitors of the time had them.
  if (passes == 1) return 0.299 * color[0] + 0.587 * color[1] + 0.114 * color[2];
  return color[static_cast<std::size_t>(pass)];
}

ScreenPlane primaryPlane(const std::array<ScreenPlane, kColors>& plane, int passes, int pass) {
  const auto of = [&](double ScreenPlane::*member) {
    return primary({plane[0].*member, plane[1].*member, plane[2].*member}, passes, pass);
  };
  return {of(&ScreenPlane::value), of(&ScreenPlane::per_i), of(&ScreenPlane::per_j)};
}

// Of the words. Numbers that do not fit them are made of the sources, by whoever plays the stream.
NumberProfile wordsProfile(const ArsOptions& options) {
  const NumberProfile wanted = frameNumbers(options);
  if (wanted.fitsTriangleWords()) return wanted;
  ArsOptions of_report;
  return frameNumbers(of_report);
}

class StreamWriter {
 public:
  StreamWriter(const ArsOptions& options, FrameStream& frame)
      : options_(options), profile_(wordsProfile(options)), frame_(frame) {}

  void begin(std::uint32_t sub_image, int pass, DrawPhase phase) {
    frame_.stream.batches.push_back({sub_image, static_cast<std::uint8_t>(pass), phase, {}, {}});
    frame_.owner.emplace_back();
    encode_ = {phase == DrawPhase::kForeground && options_.oversample, phase == DrawPhase::kBackground};
  }

  void add(const ProjectedTriangle& triangle, const TrianglePlanes& planes, std::uint32_t owner) {
    TriangleBatch& batch = frame_.stream.batches.back();
    batch.triangles.push_back(
        encodeTriangleWords(encodeTriangle(triangle, planes, profile_, encode_).variables, profile_));
    batch.sources.push_back(triangle);
    frame_.owner.back().push_back(owner);
  }

 private:
  const ArsOptions& options_;
  NumberProfile profile_;
  FrameStream& frame_;
  EncodeOptions encode_;
};

void addBackground(const std::vector<BackgroundTriangle>& background, int passes, int pass,
                   StreamWriter& writer) {
  for (const BackgroundTriangle& each : background) {
    ProjectedTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k)
      triangle[k] = {each.corner[k].i, each.corner[k].j, 0, primary(each.color[k], passes, pass)};
    writer.add(triangle, planesOf(triangle, 0), kOfBackground);
  }
}

struct Piece {
  ScreenTriangle triangle;
  std::uint32_t owner = 0;
};

void addForeground(const std::vector<Piece>& pieces, int passes, int pass, StreamWriter& writer) {
  for (const Piece& piece : pieces) {
    const ScreenPlanes& shared = piece.triangle.planes;
    const TrianglePlanes planes{shared.anchor.i, shared.anchor.j, shared.inverse_u,
                                primaryPlane(shared.color, passes, pass),
                                primaryPlane(shared.color_over_u, passes, pass)};
    ProjectedTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const ScreenPosition& at = piece.triangle.corner[k];
      const double di = at.i - planes.i, dj = at.j - planes.j;
      triangle[k] = {at.i, at.j, planes.depth.at(di, dj), planes.color.at(di, dj)};
    }
    writer.add(triangle, planes, piece.owner);
  }
}

}  // namespace

NumberProfile frameNumbers(const ArsOptions& options) {
  NumberProfile profile = options.tiler.numbers;
  profile.depth.exponent_bias = depthBiasForHither(kHither, profile.depth.exponent_bits);
  return profile;
}

FrameStream makeFrameStream(const SceneTriangles& scene, const Environment& environment,
                            const ArsOptions& options) {
  const ViewTransform& view = environment.view;
  FrameStream frame;
  frame.stream.picture_width = view.width;
  frame.stream.picture_height = view.height;
  frame.stream.passes = options.passes;
  frame.stream.profile = wordsProfile(options);
  frame.stream.has_sources = true;
  frame.on_screen.assign(scene.triangles.size(), 0);
  StreamWriter writer(options, frame);
  const SubImageBins bins = binTriangles(scene.triangles, view);
  frame.counts = bins.left_out;
  for (int n = 0; n < subImageCount(view.width, view.height); ++n) {
    const auto sub_image = static_cast<std::uint32_t>(n);
    const SubImageOrigin origin = subImageOrigin(sub_image, view.width);
    ScreenView screen;
    screen.centre_i = view.centre_i - origin.i;
    screen.centre_j = view.centre_j - origin.j;
    screen.lines = std::min(kScreenLines, view.height - origin.i);
    screen.pixels = std::min(kScreenPixels, view.width - origin.j);
    screen.hither = kHither;
    const Pretiler pretiler(screen);
    std::vector<Piece> pieces;
    std::vector<ScreenTriangle> of_triangle;
    for (const std::uint32_t t : bins.triangles[sub_image]) {
      of_triangle.clear();
      pretiler.process(scene.triangles[t], of_triangle, frame.counts);
      if (!of_triangle.empty()) frame.on_screen[t] = 1;
      for (const ScreenTriangle& piece : of_triangle) pieces.push_back({piece, t});
    }
    const std::vector<BackgroundTriangle> background =
        backgroundTriangles(environment, origin.i, origin.j, screen.lines, screen.pixels);
    for (int pass = 0; pass < options.passes; ++pass) {
      writer.begin(sub_image, pass, DrawPhase::kBackground);
      addBackground(background, options.passes, pass, writer);
      writer.begin(sub_image, pass, DrawPhase::kForeground);
      addForeground(pieces, options.passes, pass, writer);
    }
  }
  return frame;
}

}  // namespace deltaz::ars
