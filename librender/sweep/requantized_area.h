// A database like another one but for the step of its heights: what a coarser quantum would save, and cost.
//
// The posts of every grid are rounded to the nearest multiple of the new quantum and built anew; colour maps,
// models and placements are copied as they are, so models keep their altitude. Errors: kUsage if the heights
// do not fit the new quantum; those of reading and building. Cost: a build, all posts in memory.
// Thread-safety: one thread a call.
#pragma once

#include <string>

#include "formats/file_system.h"
#include "libdb/access/database.h"

namespace deltaz {

// `target` must not exist.
Status buildRequantized(const FileSystem& files, const Database& database, const Rational& quantum,
                        const std::string& target, int threads);

}  // namespace deltaz
