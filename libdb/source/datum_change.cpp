// The part of reference_system.h that asks PROJ itself: GDAL does not tell which operation it takes, how
// accurate it is, and which grid files are missing.
#include <array>
#include <memory>
#include <proj.h>
#include <set>

#include "libdb/source/reference_system.h"

namespace deltaz {

namespace {

struct DestroyContext {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
struct DestroyObject {
  void operator()(PJ* object) const { proj_destroy(object); }
};
struct DestroyList {
  void operator()(PJ_OBJ_LIST* list) const { proj_list_destroy(list); }
};
struct DestroyFactory {
  void operator()(PJ_OPERATION_FACTORY_CONTEXT* factory) const {
    proj_operation_factory_context_destroy(factory);
  }
};
using Object = std::unique_ptr<PJ, DestroyObject>;

}  // namespace

DatumChangeFacts datumChangeFacts(const ReferenceSystem& from, const ReferenceSystem& to, double longitude,
                                  double latitude) {
  DatumChangeFacts facts;
  const std::unique_ptr<PJ_CONTEXT, DestroyContext> context(proj_context_create());
  proj_log_level(context.get(), PJ_LOG_NONE);
  const Object source(proj_create(context.get(), from.wkt.c_str()));
  const Object target(proj_create(context.get(), to.wkt.c_str()));
  const std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, DestroyFactory> factory(
      proj_create_operation_factory_context(context.get(), nullptr));
  if (!source || !target || !factory) return facts;
  proj_operation_factory_context_set_area_of_interest(context.get(), factory.get(), longitude, latitude,
                                                      longitude, latitude);
  proj_operation_factory_context_set_spatial_criterion(context.get(), factory.get(),
                                                       PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  proj_operation_factory_context_set_grid_availability_use(context.get(), factory.get(),
                                                           PROJ_GRID_AVAILABILITY_IGNORED);
  const std::unique_ptr<PJ_OBJ_LIST, DestroyList> operations(
      proj_create_operations(context.get(), source.get(), target.get(), factory.get()));
  if (!operations) return facts;
  std::set<std::string> named;
  // Best first. What comes behind the first one that can be carried out does not matter.
  for (int i = 0; i < proj_list_get_count(operations.get()); ++i) {
    const Object operation(proj_list_get(context.get(), operations.get(), i));
    if (!operation || proj_coordoperation_has_ballpark_transformation(context.get(), operation.get()) != 0)
      continue;
    bool complete = true;
    for (int grid = 0; grid < proj_coordoperation_get_grid_used_count(context.get(), operation.get());
         ++grid) {
      const char* name = nullptr;
      int available = 0;
      if (proj_coordoperation_get_grid_used(context.get(), operation.get(), grid, &name, nullptr, nullptr,
                                            nullptr, nullptr, nullptr, &available) == 0 ||
          available != 0)
        continue;
      complete = false;
      if (name != nullptr && named.insert(name).second)
        facts.missing_grids += (facts.missing_grids.empty() ? "" : ", ") + std::string(name);
    }
    if (!complete) continue;
    const char* name = proj_get_name(operation.get());
    facts.operation = name == nullptr ? "an unnamed operation" : name;
    const double accuracy = proj_coordoperation_get_accuracy(context.get(), operation.get());
    if (accuracy >= 0) facts.accuracy = accuracy;
    break;
  }
  return facts;
}

}  // namespace deltaz
