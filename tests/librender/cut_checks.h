// What must hold of a cut through an area, checked from definitions: the mesh has no cracks, nothing is drawn
// twice, and every drawn face is within the tolerance. Slow and simple on purpose.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "librender/objects/border_stitcher.h"
#include "librender/scene/scheduler.h"

namespace deltaz {

// A node of a cut as it is drawn, faces before back-face removal.
struct MeshNode {
  std::uint32_t cut_node = 0;
  TerrainVertices vertices;
  std::vector<std::array<std::int64_t, 2>> posts;  // level-0 index of each vertex
  std::vector<std::array<std::uint32_t, 3>> faces;
  // Vertices of seams stand behind those of `posts`.
  std::vector<BorderStitcher::SeamVertexName> seam_vertices;
};

// Nodes of a cut, processed and stitched.
struct CutMesh {
  std::vector<CutNode> cut;
  std::vector<std::optional<TerrainTile>> tiles;  // of each cut node that is here
  std::vector<MeshNode> nodes;
};
enum class MeshPart : std::uint8_t {
  kWholeCut,  // all nodes, in view or not
  kInView,    // what a picture draws, stitched as it stitches it; the others' tiles are missing
};
CutMesh meshOfCut(const Database& database, const Schedule& schedule, const ViewTransform& view,
                  MeshPart part = MeshPart::kWholeCut);

// The first fault found; empty if every edge off the coverage boundary is shared by exactly two faces with
// identical vertices, every vertex of a post is the same wherever it is used, all faces turn the same way in
// plan, and together they cover exactly what the valid faces of the cut's tiles cover.
std::string findCrack(const Database& database, const CutMesh& mesh);

// The same for areas with seams, where plan is what lies on the ellipsoid: every edge that has ground beyond
// it, of whichever grid, is shared by exactly two faces with identical vertices, and no face is turned over.
std::string findSeamCrack(const Database& database, const CutMesh& mesh);

// Heights of a whole grid at full resolution.
class FullResolution {
 public:
  FullResolution(const Database& database, int grid);
  bool isValid(std::int64_t column, std::int64_t row) const;
  std::int32_t height(std::int64_t column, std::int64_t row) const;

 private:
  PostRange columns_, rows_;
  std::vector<std::int32_t> heights_;
  std::vector<std::uint8_t> valid_;
};

struct ContractFinding {
  double worst_pixels = 0;        // over all posts in the picture under faces in view
  double worst_strip_pixels = 0;  // the same, under faces that touch a border between levels
  std::uint64_t posts = 0;
};
// The LOD contract: the distance on the screen between a full-resolution post and the point of the drawn face
// over it along the ellipsoid normal, at every post that a face of a node in view covers.
ContractFinding measureContract(const Database& database, const CutMesh& mesh, const FullResolution& full,
                                const ViewTransform& view);

// Number of random views to try in each area: DELTAZ_VIEWS of the environment, or so many by default.
int viewsPerArea(int by_default);

// For messages: enough to draw the view again.
std::string inWords(const Camera& camera);

// Views of all sorts: over the ground, in it, under water, straight up and down, far away, from 1 cm to
// 10^7 m, wide and narrow.
Camera randomView(const Database& database, std::mt19937& random, int width, int height);

}  // namespace deltaz
