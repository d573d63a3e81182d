// Proves a database right or says exactly what is wrong with it. The library behind dbcheck.
//
// Levels, each including the ones before it:
//   structure  area.json, file lengths and identities, headers, footers, block index, the tree of node
//              records; trees of colour maps and models, transforms, numbers of placements
//   checksum   every block against its checksum, file identities against contents, padding
//   decode     every node's terrain: it decodes, agrees with its record, its parent's posts and its
//              neighbours' ring; texels against borders and means; meshes and placements against spheres
//              and the ground
//   geometry   what the database says of its own accuracy, recomputed in other ways than the builder's:
//              geometric, RMS and coverage errors, normal cones and normals, control points, LOD ranges,
//              errors of models' coarser meshes. Needs the full-resolution posts in memory, five bytes a
//              post of a grid
// `against` adds a comparison with the sources, post for post.
//
// A damaged database never makes a check crash or stop early without saying so (Report::complete).
// Thread-safety: one check at a time per Report.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/error.h"
#include "formats/file_system.h"
#include "formats/issue_code.h"
#include "libdb/source/elevation_source.h"

namespace deltaz {

enum class CheckLevel : std::uint8_t { kStructure, kChecksum, kDecode, kGeometry };
inline constexpr CheckLevel kDeepestLevel = CheckLevel::kGeometry;
enum class Severity : std::uint8_t { kInformation, kWarning, kError };

// Where an issue is. Members that do not apply are empty.
struct IssueLocation {
  std::string file;  // name in the database folder
  std::optional<std::uint32_t> block;
  std::optional<std::uint64_t> offset;  // bytes
  std::optional<std::uint32_t> node;    // record number
  std::optional<int> level;
  std::optional<std::int32_t> x, y;
  std::optional<double> longitude, latitude;  // degrees
};

struct Issue {
  IssueCode code = IssueCode::kNone;
  Severity severity = Severity::kError;
  std::string message;
  IssueLocation where;
  std::optional<double> magnitude;  // how bad, in the unit the message names (metres for heights)
};

// Issues of one code: the count is exact, the first kKeptIssues are kept, and the worst by magnitude.
inline constexpr std::size_t kKeptIssues = 10;
struct IssueGroup {
  IssueCode code = IssueCode::kNone;
  Severity severity = Severity::kError;
  std::uint64_t count = 0;
  std::vector<Issue> first;
  std::optional<Issue> worst;
};

struct CheckOptions {
  CheckLevel level = CheckLevel::kDecode;
  // The sources, already read, one after the other in memory, one grid each (SourceOptions::join) unless the
  // database is resampled. Each grid of the database is compared with all sources area.json names for it, in
  // that order; those that are not given leave the report incomplete.
  const RawGrid* against = nullptr;
  std::size_t against_count = 1;
  std::string against_name;  // for messages
  int threads = 0;
  // Leaves whose errors level "geometry" recomputes post by post, percent of all, 0 to 100; always the same
  // ones. The others' own statements are taken for true.
  double sample_percent = 100;
};

struct Report {
  std::vector<IssueGroup> groups;    // in the order of the codes
  bool complete = true;              // every check of the level ran to its end
  std::vector<std::string> skipped;  // what did not run, and why
  std::vector<std::string> notes;    // what there was nothing to check of
  std::uint64_t nodes_checked = 0, blocks_checked = 0, bytes_checked = 0, posts_compared = 0;
  std::uint64_t leaves_measured = 0;  // whose errors were recomputed
  // Set when the database could not be opened or read, is newer than this version, or the check itself
  // failed. The issue stands in groups too, except for the check's own failure (kInternal), which is no
  // property of the database.
  std::optional<Error> fatal;

  void add(Issue issue);
  std::uint64_t count(Severity severity) const;
};

// Never fails: what goes wrong is in the report.
Report checkDatabase(const FileSystem& files, const std::string& path, const CheckOptions& options);

}  // namespace deltaz
