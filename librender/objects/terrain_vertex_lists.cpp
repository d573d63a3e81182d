#include "librender/objects/terrain_vertex_lists.h"

#include "libdb/access/vertex_normals.h"
#include "librender/objects/transform_posts.h"

namespace deltaz {

void terrainVertexLists(const TerrainTile& tile, const GridGeometry& geometry, const ViewTransform& view,
                        const Light& light, TerrainVertexLists& lists, const TerrainVertexOptions& options) {
  thread_local TilePosts posts;
  thread_local VectorLists normals;
  if (tile.columns < 1 || tile.rows < 1) {
    lists.position.resize(0);
    normals.resize(0);
    terrainIntensity(normals, light, lists.intensity);
    for (std::vector<double>* list : {&lists.color.red, &lists.color.green, &lists.color.blue})
      resizePadded(*list, 0);
    return;
  }
  posts.prepare(tile, geometry);
  if (options.transform == TransformKind::kExact) {
    terrainViewPositions(posts, view, lists.position);
  } else {
    TileTransform::make(options.transform, tile, geometry).value().apply(view, lists.position);
  }
  vertexNormals(posts, normals);
  terrainIntensity(normals, light, lists.intensity);
  if (options.coloring == PostColoring::kByRule) terrainColors(posts, normals, lists.intensity, lists.color);
}

}  // namespace deltaz
