// consumer AREA.dz LATITUDE LONGITUDE: opens a database, asks for the ground and draws a small picture of it.
#include <cstdlib>
#include <iostream>

#include "formats/file_system.h"
#include "libdb/access/database.h"
#include "libdb/access/ground_query.h"
#include "librender/scene/render.h"

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const auto database = deltaz::Database::open(deltaz::localFileSystem(), argv[1]);
  if (!database.ok()) {
    std::cerr << database.error().message() << '\n';
    return 1;
  }
  const auto ground = deltaz::groundHeight(database.value(), std::atof(argv[2]), std::atof(argv[3]));
  if (!ground.ok() || !ground.value()) return 1;
  deltaz::RenderOptions options;
  options.camera = deltaz::wholeAreaCamera(database.value().area(), 32, 24, 60);
  deltaz::FrameStatistics statistics;
  const auto picture =
      deltaz::makeEngine(deltaz::EngineKind::kFast)->render(database.value(), options, statistics);
  if (!picture.ok()) return 1;
  std::cout << *ground.value() << '\n';
  return 0;
}
