#include "tools/dbview/depth_description.h"

#include "tools/common/json_output.h"
#include "tools/dbview/statistics_json.h"

namespace deltaz {

std::string depthDescription(const Database& database, const Camera& camera) {
  const EllipsoidShape ellipsoid =
      database.gridCount() > 0 ? database.grid(0).header().ellipsoid : EllipsoidShape{};
  const ViewTransform view = makeViewTransform(camera, ellipsoid);
  const auto vector = [](const Vector3& v) { return Json::array({v.x, v.y, v.z}); };
  Json json = jsonHeader("dbview");
  json["content"] = "metres along the view axis (forward); infinity is sky";
  json["camera"] = cameraJson(camera);
  json["semi_major_axis"] = ellipsoid.semi_major_axis;
  json["inverse_flattening"] = ellipsoid.inverse_flattening;
  json["eye"] = vector(view.eye);
  json["forward"] = vector(view.forward);
  json["right"] = vector(view.right);
  json["down"] = vector(view.down);
  json["pixels"] = view.pixels;
  json["centre_j"] = view.centre_j;
  json["centre_i"] = view.centre_i;
  return json.dump();
}

}  // namespace deltaz
