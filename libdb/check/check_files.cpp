// area.json, the files it lists, and what else lies in the folder.
#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "formats/seam.h"
#include "libdb/access/node_pages.h"
#include "libdb/access/referenced_file.h"
#include "libdb/check/check_context.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

IssueLocation inFile(const std::string& name) {
  IssueLocation where;
  where.file = name;
  return where;
}

// Nothing can be checked: the one finding is the error that says why.
bool refuse(CheckContext& context, const Error& error, const std::string& file) {
  addError(context.report, error, inFile(file));
  context.report.fatal = error;
  addSkipped(context.report, "everything behind area.json, which could not be read");
  return false;
}

// True if area.json could be read.
bool readArea(CheckContext& context) {
  const std::string area_path = joinPath(context.path, std::string(kAreaFileName));
  const auto folder = context.files.typeOf(context.path);
  if (!folder.ok()) return refuse(context, folder.error(), "");
  if (folder.value() == PathType::kAbsent) {
    Error error = accessError(context.path, "there is no such database");
    error.code = IssueCode::kIoMissingFile;
    return refuse(context, error, "");
  }
  const auto type = context.files.typeOf(area_path);
  if (!type.ok()) return refuse(context, type.error(), std::string(kAreaFileName));
  if (folder.value() != PathType::kDirectory || type.value() == PathType::kAbsent) {
    return refuse(context,
                  invalidError(IssueCode::kIoMissingFile, context.path, "this is not a deltaz database",
                               "it is not a folder with an area.json in it"),
                  std::string(kAreaFileName));
  }
  auto bytes = readWholeFile(context.files, area_path, kMaximumAreaBytes);
  if (!bytes.ok()) return refuse(context, bytes.error(), std::string(kAreaFileName));
  std::string text(bytes.value().size(), '\0');
  std::transform(bytes.value().begin(), bytes.value().end(), text.begin(),
                 [](std::byte byte) { return static_cast<char>(byte); });
  context.report.bytes_checked += text.size();
  auto area = parseArea(text, area_path);
  if (!area.ok()) return refuse(context, area.error(), std::string(kAreaFileName));
  context.area = std::move(area).value();
  return true;
}

Status openContainer(CheckContext& context, CheckedFile& file) {
  const FileReference& reference = file.reference;
  const std::string path = joinPath(context.path, reference.name);
  DELTAZ_TRY_ASSIGN(const PathType type, context.files.typeOf(path));
  if (type == PathType::kAbsent) {
    return invalidError(IssueCode::kIoMissingFile, path, "area.json lists this file, but it is not there");
  }
  DELTAZ_TRY_ASSIGN(ContainerReader container,
                    ContainerReader::open(context.files, path, contentKindOf(reference.role)));
  const FileIdentity& identity = container.identity();
  if (identity.length != reference.length || identity.id != reference.id) {
    return invalidError(
        IssueCode::kManFileMismatch, path,
        fmt::format("area.json lists {} bytes with identity {}, the file has {} with {}", reference.length,
                    toHex(reference.id), identity.length, toHex(identity.id)));
  }
  DELTAZ_TRY(container.checkIndex());
  file.damaged_blocks.assign(container.blockCount(), 0);
  file.container = std::move(container);
  return Success{};
}

void openFile(CheckContext& context, CheckedFile& file) {
  const Status opened = openContainer(context, file);
  if (opened.ok()) return;
  addError(context.report, opened.error(), inFile(file.reference.name));
  addSkipped(context.report,
             fmt::format("the contents of {}, which could not be opened", file.reference.name));
}

// What readers rely on in the list of files as a whole: one node file of the right number of pages, terrain
// segments numbered from 0 on, and a file for each colour map and model in the order of their headers.
void checkFileList(CheckContext& context) {
  const auto complain = [&](std::string message) {
    context.report.add(
        makeIssue(IssueCode::kManField, std::move(message), inFile(std::string(kAreaFileName))));
  };
  std::size_t node_files = 0;
  std::map<FileRole, std::uint32_t> next;
  for (const CheckedFile& file : context.listed) {
    const FileRole role = file.reference.role;
    if (role == FileRole::kNodes) ++node_files;
    const bool numbered = role == FileRole::kTerrain || role == FileRole::kColors ||
                          role == FileRole::kModel || role == FileRole::kPlacements;
    if (numbered && file.reference.segment != next[role]++) {
      complain(fmt::format("file {} of role {} is number {}, which is out of order", file.reference.name,
                           fileRoleName(role), file.reference.segment));
    }
  }
  const auto expect = [&](FileRole role, std::size_t count) {
    if (next[role] == count) return;
    complain(fmt::format("{} files of role {} are listed, not {}", next[role], fileRoleName(role), count));
  };
  expect(FileRole::kColors, context.area.color_maps.size());
  expect(FileRole::kModel, context.area.models.size());
  if (next[FileRole::kPlacements] > 1) complain("two files of placements are listed");
  if (node_files != 1) complain(fmt::format("{} node files are listed, not one", node_files));
  if (context.nodes == nullptr) return;
  const std::uint32_t pages = nodePageCount(context.area);
  const std::uint32_t blocks = context.nodes->container->blockCount();
  if (blocks != pages) {
    complain(fmt::format("{} node records need {} pages, the node file has {}", context.area.node_count,
                         pages, blocks));
    // Without a count to believe there are no records to walk.
    context.nodes = nullptr;
  }
}

// The control points of grid `grid`; none if it needs none. What is wrong with them is reported, and clears
// context.positions_known.
std::shared_ptr<const PatchLattice> patchesOf(CheckContext& context, std::size_t grid) {
  const std::optional<PatchPlacement>& placement = context.area.grids[grid].patches;
  const CheckedFile* found = nullptr;
  std::size_t files = 0;
  for (const CheckedFile& file : context.listed) {
    if (file.reference.role != FileRole::kPatches || file.reference.segment != grid) continue;
    ++files;
    found = &file;
  }
  if (files != (placement ? 1u : 0u)) {
    context.report.add(makeIssue(IssueCode::kManField,
                                 fmt::format("{} files with control points are listed for grid {}, not {}",
                                             files, grid, placement ? 1 : 0),
                                 inFile(std::string(kAreaFileName))));
    if (placement) context.positions_known = false;
    return nullptr;
  }
  if (!placement) return nullptr;
  if (found->container) {
    auto lattice = readPatchLattice(*found->container, *placement);
    if (lattice.ok()) return std::move(lattice).value();
    addError(context.report, lattice.error(), inFile(found->reference.name));
  }
  context.positions_known = false;
  return nullptr;
}

// Reads the seams between grids; what is wrong with them is reported.
void readSeams(CheckContext& context) {
  std::size_t files = 0;
  for (const CheckedFile& file : context.listed) {
    if (file.reference.role != FileRole::kSeams) continue;
    if (++files == 2) {
      context.report.add(makeIssue(IssueCode::kManField, "two files of seams are listed",
                                   inFile(std::string(kAreaFileName))));
    }
    if (!file.container) continue;
    for (std::uint32_t block = 0; block < file.container->blockCount(); ++block) {
      IssueLocation where = inFile(file.reference.name);
      where.block = block;
      const auto bytes = file.container->read(block, BlockType::kSeam);
      if (!bytes.ok()) {
        addError(context.report, bytes.error(), where);
        continue;
      }
      auto seam = decodeSeam(bytes.value(), context.area.grids,
                             fmt::format("{}, block {}", file.reference.name, block));
      if (seam.ok()) {
        context.seams.push_back(std::move(seam).value());
      } else {
        addError(context.report, seam.error(), where);
      }
    }
  }
}

}  // namespace

bool openDatabaseFiles(CheckContext& context) {
  if (!readArea(context)) return false;
  context.listed.resize(context.area.files.size());
  for (std::size_t i = 0; i < context.listed.size(); ++i) {
    CheckedFile& file = context.listed[i];
    file.reference = context.area.files[i];
    openFile(context, file);
    if (file.reference.role == FileRole::kTerrain) {
      context.segments.emplace(file.reference.segment, &file);
    } else if (file.reference.role == FileRole::kNodes && file.container) {
      context.nodes = &file;
    }
  }
  for (std::size_t grid = 0; grid < context.area.grids.size(); ++grid)
    context.grids.emplace_back(context.area.grids[grid], patchesOf(context, grid));
  readSeams(context);
  checkFileList(context);
  return true;
}

void checkFolder(CheckContext& context) {
  const auto names = context.files.list(context.path);
  if (!names.ok()) return addError(context.report, names.error());
  std::set<std::string_view> known = {kAreaFileName, kLockFileName};
  for (const CheckedFile& file : context.listed) known.insert(file.reference.name);
  for (const std::string& name : names.value()) {
    if (known.contains(name)) continue;
    context.report.add(makeIssue(IssueCode::kIoUnreferencedFile,
                                 "area.json does not list this file; readers ignore it", inFile(name)));
  }
}

}  // namespace deltaz
