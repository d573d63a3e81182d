// Puts a finished colour map into a database, and takes one out: the edits of area.json.
// Errors: kUsage, naming the map; whatever publishing reports.
#pragma once

#include <functional>
#include <string>

#include "formats/area.h"
#include "libdb/build/color_map_writer.h"
#include "libdb/build/publication.h"

namespace deltaz {

// Adds the map `header` describes, with the tiles `fill` writes, to the database at `target`; the terrain is
// not touched. A map of this name is replaced, at its place in the list, with `overwrite`, else kUsage.
// Returns the bytes of the new file.
Result<std::uint64_t> addColorMap(
    const FileSystem& files, const std::string& target, const AssetHeader& header, bool overwrite,
    const std::function<Status(const AreaHeader& area, ColorMapWriter& writer)>& fill);

Status removeColorMap(const FileSystem& files, const std::string& target, const std::string& name);

// What addColorMap would refuse at once.
Status checkColorMapName(const AreaHeader& area, const std::string& target, const std::string& name,
                         bool overwrite);

}  // namespace deltaz
