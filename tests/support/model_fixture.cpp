#include "tests/support/model_fixture.h"

#include <cmath>
#include <stdexcept>

#include "libdb/access/database.h"
#include "libdb/build/placement_writer.h"
#include "libdb/build/publication.h"

namespace deltaz {

namespace {

void orThrow(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.error().message());
}

// A box on the ground around the z axis, with a pyramid `roof` high on it, or a flat top if that is 0.
ModelMesh house(float width, float depth, float height, float roof) {
  const float x = width / 2, y = depth / 2;
  ModelMesh mesh;
  for (const float z : {0.0F, height}) {
    mesh.vertices.push_back({-x, -y, z});
    mesh.vertices.push_back({x, -y, z});
    mesh.vertices.push_back({x, y, z});
    mesh.vertices.push_back({-x, y, z});
  }
  const auto addQuad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  addQuad(3, 2, 1, 0);
  for (std::uint32_t k = 0; k < 4; ++k) addQuad(k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4);
  if (roof > 0) {
    mesh.vertices.push_back({0, 0, height + roof});
    for (std::uint32_t k = 0; k < 4; ++k) mesh.triangles.push_back({k + 4, (k + 1) % 4 + 4, 8});
  } else {
    addQuad(4, 5, 6, 7);
  }
  return mesh;
}

void colorTriangles(ModelMesh& mesh) {
  // Walls grey, floor and roof each of another colour.
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t < 2) {
      mesh.colors.push_back({60, 50, 40});
    } else if (t < 10) {
      mesh.colors.push_back({150, 150, 160});
    } else {
      mesh.colors.push_back({180, 60, 40});
    }
  }
}

// Normals away from the middle of the box, colours by height.
void shadeVertices(ModelMesh& mesh, float height) {
  mesh.colored_by_vertex = true;
  for (const auto& [x, y, z] : mesh.vertices) {
    const float dz = z - height / 2;
    const float scale = 32767.0F / std::sqrt(x * x + y * y + dz * dz);
    mesh.normals.push_back({static_cast<std::int16_t>(x * scale), static_cast<std::int16_t>(y * scale),
                            static_cast<std::int16_t>(dz * scale)});
    mesh.colors.push_back(z > 0 ? std::array<std::uint8_t, 3>{230, 230, 80}
                                : std::array<std::uint8_t, 3>{40, 90, 40});
  }
}

}  // namespace

FinishedModel fixtureModel() {
  FinishedPart base;
  base.name = "base";
  for (const float roof : {4.0F, 0.0F}) {
    ModelMesh mesh = house(10, 6, 20, roof);
    colorTriangles(mesh);
    base.lods.push_back({std::move(mesh), 4 - roof});
  }
  FinishedPart head;
  head.name = "head";
  head.parent = 0;
  head.transform[11] = 24;
  for (const float roof : {1.0F, 0.0F}) {
    ModelMesh mesh = house(4, 4, 4, roof);
    shadeVertices(mesh, 4);
    head.lods.push_back({std::move(mesh), 1 - roof});
  }
  return {{base, head}, {0, 0, 0}};
}

void addFixtureModel(const FileSystem& files, const std::string& target, const std::string& name) {
  orThrow(putModel(files, target, {name, "mesh", {{"tower.obj", hash128({})}}, {}}, fixtureModel(), false));
}

void setPlacements(const FileSystem& files, const std::string& target, std::vector<Placement> placements) {
  std::vector<ModelTree> trees;
  {
    const Result<Database> database = Database::open(files, target);
    if (!database.ok()) throw std::runtime_error(database.error().message());
    for (const Model& model : database.value().models()) trees.push_back(model.tree());
  }
  Result<Publication> publication = Publication::beginEdit(files, target);
  if (!publication.ok()) throw std::runtime_error(publication.error().message());
  AreaHeader area = publication.value().area();
  std::uint32_t next = 1;
  for (Placement& placement : placements) placement.instance = next++;
  orThrow(writePlacements(files, publication.value(), area, std::move(placements), next, trees));
  orThrow(publication.value().publish(area));
}

Placement placementAt(double latitude, double longitude, double height, double heading) {
  Placement placement;
  placement.latitude = latitude;
  placement.longitude = longitude;
  placement.height = height;
  placement.heading = heading;
  return placement;
}

}  // namespace deltaz
