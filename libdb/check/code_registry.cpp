#include "libdb/check/code_registry.h"

#include <array>
#include <cassert>

namespace deltaz {
namespace {

constexpr std::string_view kRestore =
    "Restore the file from a copy, or rebuild the database from its sources; then look for failing storage "
    "or a faulty transfer.";
constexpr std::string_view kRebuild =
    "Rebuild the database from its sources. The checksums are right, so it was written like this: please "
    "report it with the tool version in area.json.";
constexpr std::string_view kRebuildColors =
    "Make the colour map anew (dbbuild color). The checksums are right, so it was written like this: please "
    "report it with the tool version in area.json.";
constexpr std::string_view kRebuildModel =
    "Make the model anew (dbbuild model). The checksums are right, so it was written like this: please "
    "report it with the tool version in area.json.";
constexpr std::string_view kUpgrade =
    "Use a deltaz at least as new as the one that wrote the database (provenance in area.json).";

constexpr Severity kError = Severity::kError;
constexpr CheckLevel kStructure = CheckLevel::kStructure;
constexpr CheckLevel kChecksum = CheckLevel::kChecksum;
constexpr CheckLevel kDecode = CheckLevel::kDecode;
constexpr CheckLevel kGeometry = CheckLevel::kGeometry;

constexpr std::array kRegistry = {
    CodeDescription{
        IssueCode::kIoCannotRead, kError, kStructure, "a file cannot be read",
        "The operating system refused to open or read the file: permissions, a failing disk, a lost network "
        "folder. Nothing is said about what the file holds.",
        "Check permissions and storage, then run again.", "area.md 2"},
    CodeDescription{
        IssueCode::kIoMissingFile, kError, kStructure, "a file of the database is not there",
        "area.json, or a file it lists, is missing. Databases are folders; copying one file of them, or a "
        "cleanup that removed what it did not know, leaves this behind.",
        kRestore, "area.md 2"},
    CodeDescription{IssueCode::kIoUnreferencedFile, Severity::kInformation, kStructure,
                    "a file that area.json does not list",
                    "The folder holds a file no reader looks at: the rest of an interrupted edit, an older "
                    "generation still "
                    "in use by a reader, or something put there by hand.",
                    "Harmless. Remove it when no program has the database open.", "area.md 2"},
    CodeDescription{IssueCode::kHdrMagic, kError, kStructure, "not a deltaz file",
                    "The first bytes are not the magic number. The file is something else, or went through a "
                    "transfer that "
                    "rewrites line ends.",
                    kRestore, "container.md 1.1"},
    CodeDescription{
        IssueCode::kHdrVersionNewer, kError, kStructure, "written in a newer version of the format",
        "The version stands above what this program knows. It does not guess: the verdict stays open.",
        kUpgrade, "container.md 3"},
    CodeDescription{
        IssueCode::kHdrFeatureUnknown, kError, kStructure, "needs a feature this program does not have",
        "A required feature is named that this version does not know. Reading on could give wrong data: the "
        "verdict stays open.",
        kUpgrade, "container.md 3"},
    CodeDescription{IssueCode::kHdrField, kError, kStructure,
                    "a header or footer field has an impossible value",
                    "Version, kind, reserved bytes, block count or index offset do not fit each other or the "
                    "file's length, "
                    "although the checksum holds.",
                    kRestore, "container.md 1.1"},
    CodeDescription{IssueCode::kHdrChecksum, kError, kStructure, "the header does not match its checksum",
                    "A byte of the first 32 was changed after it was written.", kRestore, "container.md 1.1"},
    CodeDescription{IssueCode::kHdrLength, kError, kStructure, "the file has the wrong length",
                    "It is too short to be a container, or its footer states another length: it was cut, or "
                    "bytes were put "
                    "into it.",
                    kRestore, "container.md 1.3"},
    CodeDescription{IssueCode::kHdrFooter, kError, kStructure, "the file does not end in a valid footer",
                    "The footer is written last. Without it the file was cut short, added to, damaged at its "
                    "end, or never "
                    "finished.",
                    kRestore, "container.md 1.3"},
    CodeDescription{IssueCode::kIdxChecksum, kError, kStructure, "a page of the block index is damaged",
                    "The page does not match its checksum, so none of its blocks can be found.", kRestore,
                    "container.md 1.2"},
    CodeDescription{
        IssueCode::kIdxOrder, kError, kStructure, "blocks overlap, leave gaps or lie outside",
        "The index is intact but its blocks do not follow each other from the header to the index.", kRebuild,
        "container.md 1.2"},
    CodeDescription{IssueCode::kSumBlock, kError, kChecksum, "a block does not match its checksum",
                    "Its bytes were changed, or it belongs to another place or another file: the checksum "
                    "covers all three. "
                    "Readers refuse the block.",
                    kRestore, "container.md 2"},
    CodeDescription{IssueCode::kSumFileId, kError, kChecksum,
                    "a file's identity does not follow from its contents",
                    "Every block is intact, but together they do not give the identity in the footer.",
                    kRebuild, "container.md 1.3"},
    CodeDescription{
        IssueCode::kSumPadding, kError, kChecksum, "padding between blocks is not zero",
        "No data is wrong, but a byte was changed that nothing may change: storage or transfer is not to be "
        "trusted.",
        kRestore, "container.md 1"},
    CodeDescription{
        IssueCode::kManHash, kError, kStructure, "area.json does not match its hash",
        "It was damaged, cut short, or edited by hand. Nothing in it can be believed, so nothing else was "
        "checked.",
        kRestore, "area.md 1"},
    CodeDescription{IssueCode::kManSyntax, kError, kStructure, "area.json is not the header of a database",
                    "The file is not JSON, or it is JSON of something else.", kRestore, "area.md 1"},
    CodeDescription{IssueCode::kManField, kError, kStructure, "area.json holds an impossible value",
                    "The hash is right, but a member is missing, unknown, out of range, or contradicts "
                    "another one or the "
                    "files.",
                    kRebuild, "area.md 2"},
    CodeDescription{
        IssueCode::kManFileMismatch, kError, kStructure, "a file is not the one area.json lists",
        "Length or identity differ: the file, sound in itself, comes from another database or another "
        "generation of this one.",
        "Bring back the file that belongs to this area.json, or rebuild the database.", "area.md 2"},
    CodeDescription{IssueCode::kRefRange, kError, kStructure, "a link leads past the last record",
                    "First child or sibling of a node names a record that does not exist.", kRebuild,
                    "node_file.md 2"},
    CodeDescription{IssueCode::kRefCycle, kError, kStructure,
                    "a link leads to a record that has its place already",
                    "The node records do not form a tree: following the links would go round for ever or "
                    "draw a node twice.",
                    kRebuild, "node_file.md 1"},
    CodeDescription{IssueCode::kRefUnreachable, kError, kStructure, "no link leads to a record",
                    "The node exists but can never be found from the root: a hole in every picture.",
                    kRebuild, "node_file.md 1"},
    CodeDescription{IssueCode::kRefChild, kError, kStructure, "a node is not what its parent's child must be",
                    "Level, position, child number, grid or order of a node contradict its parent.", kRebuild,
                    "node_file.md 1"},
    CodeDescription{IssueCode::kRefRecord, kError, kStructure, "a node record holds an impossible value",
                    "A page is not packed as it must be, or has too many or too few records, or type, flags, "
                    "level or position of a record are out "
                    "of range.",
                    kRebuild, "node_file.md 2"},
    CodeDescription{IssueCode::kRefData, kError, kStructure, "a node's data is not where its record says",
                    "The terrain segment or block does not exist, holds something else, or belongs to "
                    "another node already.",
                    kRebuild, "node_file.md 2"},
    CodeDescription{
        IssueCode::kRefMissing, kError, kStructure, "a position has no node",
        "A level must have a node at every position that holds part of the area. One is missing: a hole.",
        kRebuild, "node_file.md 1"},
    CodeDescription{IssueCode::kTileGrid, kError, kDecode, "terrain that belongs to another place or grid",
                    "The block's number of posts, first post, spacing or quantum are not those of its node.",
                    kRebuild, "terrain_segment.md 1"},
    CodeDescription{IssueCode::kTileHeightRange, kError, kStructure, "a node's range of heights is wrong",
                    "The range is not that of the node's posts or of the nodes below. Culling and the view "
                    "volume rely on "
                    "it.",
                    kRebuild, "node_file.md 2"},
    CodeDescription{IssueCode::kTileVoids, kError, kStructure,
                    "a node's count of valid posts or its void flags are wrong",
                    "The number of valid posts, or the marks for voids and for empty nodes, contradict the "
                    "terrain or each "
                    "other.",
                    kRebuild, "node_file.md 2"},
    CodeDescription{IssueCode::kTileSphere, kError, kDecode, "a post lies outside a sphere that must hold it",
                    "The bounding sphere of a node, or of one above it, leaves out one of its posts: terrain "
                    "would vanish at "
                    "the edge of the picture.",
                    kRebuild, "node_file.md 2"},
    CodeDescription{
        IssueCode::kTileCone, kError, kGeometry, "a normal cone leaves out a facet or is too wide",
        "The cone of a node must hold the normal of every facet of the node and below it: whoever "
        "skips nodes that face away would skip what can be seen. One that is wider than its own "
        "facets and its children's cones need makes skipping useless.",
        kRebuild, "node_file.md 2"},
    CodeDescription{
        IssueCode::kTileNormal, kError, kGeometry, "a normal is not that of the facets",
        "The mean normal of a node is not the mean of its own facets, weighted with their areas; or "
        "a vertex normal on the border of two nodes differs between them, and the seam shows.",
        kRebuild, "node_file.md 2"},
    CodeDescription{IssueCode::kTileLod, kError, kGeometry,
                    "LOD ranges of a node and its parent contradict each other",
                    "Where both have ranges of distance in which they are drawn, the finer node's must begin "
                    "and end no farther away than its parent's, or near ground is drawn coarser than far.",
                    kRebuild, "node_file.md 2"},
    CodeDescription{
        IssueCode::kHgtDecode, kError, kDecode, "a node's terrain cannot be decoded",
        "The block is intact but its contents break the rules of the delta-z array or of its packing.",
        kRebuild, "terrain_segment.md 5"},
    CodeDescription{IssueCode::kHgtSubset, kError, kDecode,
                    "a coarse post differs from the same post one level finer",
                    "The posts of a node must be a subset of its children's, height for height and void for "
                    "void; otherwise "
                    "the ground jumps when the level changes.",
                    kRebuild, "node_file.md 1"},
    CodeDescription{IssueCode::kHgtRing, kError, kDecode, "a ring height differs from the neighbour's post",
                    "The ring around a node repeats its neighbours' posts, and is void outside the area; "
                    "otherwise normals "
                    "differ on the two sides of a border and the seam shows.",
                    kRebuild, "terrain_segment.md 2"},
    CodeDescription{
        IssueCode::kHgtBorder, kError, kDecode, "neighbours disagree about a post they share",
        "Two nodes of one level have different heights, or a height and a void, at a post on their common "
        "border: a crack.",
        kRebuild, "terrain_segment.md 2"},
    CodeDescription{
        IssueCode::kHgtPatches, kError, kStructure,
        "the control points of a projected grid are damaged or missing",
        "A projected grid needs a lattice of control points that places its posts on the Earth; there "
        "are not as many as area.json announces, one is nowhere near the Earth, or (level geometry) one lies "
        "beside the ellipsoid or out of line with its neighbours.",
        kRebuild, "patch_lattice.md 1"},
    CodeDescription{
        IssueCode::kHgtSeam, kError, kStructure, "a seam between two grids is damaged",
        "The file of seams says how grids that overlap meet: which faces are drawn instead of those "
        "along the edge. One of its parts leads outside its grids, or the parts do not add up.",
        kRebuild, "seam.md 1"},
    CodeDescription{IssueCode::kErrGeometric, kError, kGeometry, "a geometric error is wrong",
                    "What a node is said to differ from full resolution at most was recomputed at every post "
                    "and at points between them. It is too small, so that a picture is less exact than its "
                    "tolerance says, or larger than the definition allows.",
                    kRebuild, "node_file.md 3"},
    CodeDescription{IssueCode::kErrRms, kError, kGeometry, "an RMS error is wrong",
                    "The root mean square of a node's differences from full resolution, recomputed over all "
                    "posts, is another.",
                    kRebuild, "node_file.md 3"},
    CodeDescription{
        IssueCode::kErrAncestor, kError, kGeometry, "a leaf's error against a coarser level is wrong",
        "Leaves keep the largest difference, the sum of squares and the number of posts compared "
        "for each level above them, so that an edit need not read the whole area. Recomputed they "
        "are others: the next edit would write wrong errors.",
        kRebuild, "terrain_segment.md 4"},
    CodeDescription{IssueCode::kErrCoverage, kError, kGeometry, "a coverage error is wrong",
                    "How far the region a node draws lies from the region valid at full resolution was "
                    "recomputed. The stored distance is too small, so that land ends or begins in the wrong "
                    "place in pictures that should show it right, or larger than the definition allows.",
                    kRebuild, "node_file.md 4"},
    CodeDescription{IssueCode::kSrcHeight, kError, kDecode, "a height differs from the source",
                    "Database and source have different heights at the same post. One of them was changed, "
                    "or this is not "
                    "the source the database was built from (names and hashes are in area.json).",
                    "Compare the source's hash with the one in area.json; rebuild from the right source.",
                    "area.md 3"},
    CodeDescription{
        IssueCode::kSrcVoid, kError, kDecode, "a void differs from the source",
        "A post is void in the database and has a height in the source, or the other way round.",
        "Compare the source's hash and no-data value with those in area.json; rebuild from the right source.",
        "area.md 3"},
    CodeDescription{
        IssueCode::kSrcExtent, kError, kDecode, "database and source do not cover the same posts",
        "The grids agree, but begin at or have a different number of rows or columns. What both have was "
        "compared.",
        "Use the source the database was built from, or rebuild.", "area.md 3"},
    CodeDescription{IssueCode::kSrcGeoreference, kError, kDecode,
                    "database and source are not on the same grid",
                    "Spacing, place of the posts, ellipsoid, datum or height step differ, so heights cannot "
                    "be compared post "
                    "for post.",
                    "Use the source the database was built from, or rebuild.", "area.md 3"},
    CodeDescription{
        IssueCode::kColorTree, kError, kStructure, "the tree of a colour map is wrong",
        "A record of a colour map leads outside its file, stands where its parent does not say, is "
        "reached twice or never, or its levels or its order do not agree.",
        kRebuildColors, "color_file.md 1"},
    CodeDescription{IssueCode::kColorTile, kError, kDecode, "a tile of texels cannot be decoded",
                    "The bytes are those that were written, and they are no tile of texels.", kRebuildColors,
                    "color_file.md 1"},
    CodeDescription{IssueCode::kColorBorder, kError, kDecode, "a tile's border differs from its neighbour",
                    "The texels a tile carries of its neighbour are not the neighbour's own: pictures show a "
                    "seam between the two.",
                    kRebuildColors, "color_file.md 2"},
    CodeDescription{
        IssueCode::kColorFilter, kError, kDecode, "a texel is not the mean of those below it",
        "A texel of a coarser level was recomputed, in linear light, from the four of the finer one, "
        "and is another: colours change with distance.",
        kRebuildColors, "color_file.md 2"},
    CodeDescription{
        IssueCode::kModelTree, kError, kStructure, "the tree of a model is wrong",
        "A part has no parent that stands before it, names a mesh that is not there, or has a name "
        "or a number that cannot be.",
        kRebuildModel, "model_file.md 1"},
    CodeDescription{IssueCode::kModelMesh, kError, kDecode, "a mesh of a model is wrong",
                    "Its counts do not fit its length or its part, or a triangle names a vertex that is not "
                    "there.",
                    kRebuildModel, "model_file.md 2"},
    CodeDescription{IssueCode::kModelSphere, kError, kDecode, "a model's sphere does not hold its meshes",
                    "A vertex lies outside the sphere of its part or of the model, so that it may be missing "
                    "in pictures that should show it.",
                    kRebuildModel, "model_file.md 1"},
    CodeDescription{
        IssueCode::kModelError, kError, kGeometry, "a model's level of detail has a wrong error",
        "The distance between a part's coarser mesh and its finest one was measured anew. The stored "
        "one is too small, so that a picture is less exact than its tolerance says, or far too large.",
        kRebuildModel, "model_file.md 1"},
    CodeDescription{IssueCode::kModelLod, kError, kDecode, "a model's levels of detail are not in order",
                    "A coarser level has more triangles than a finer one, or a smaller error; the finest has "
                    "error 0.",
                    kRebuildModel, "model_file.md 1"},
    CodeDescription{IssueCode::kModelTransform, Severity::kWarning, kStructure,
                    "a part's transform is more than rotation and one scale",
                    "Light is computed in a part's own space, which is right only where the transform keeps "
                    "angles: this part is lit wrongly.",
                    "Apply the transform to the mesh before it is made a model.", "model_file.md 1"},
    CodeDescription{IssueCode::kPlacementRecord, kError, kStructure, "a placement is wrong",
                    "It names a model that is not there, has a number that another has or that was never "
                    "given, or a position that cannot be.",
                    "Place the models anew (dbbuild place).", "placement_file.md 1"},
    CodeDescription{IssueCode::kPlacementSphere, kError, kDecode,
                    "a page's sphere does not hold what stands on it",
                    "A model reaches out of the sphere of its page, so that it may be missing in pictures "
                    "that should show it.",
                    "Place the models anew (dbbuild place).", "placement_file.md 1"},
    CodeDescription{IssueCode::kPlacementGround, Severity::kWarning, kDecode,
                    "a model does not stand on the ground",
                    "It was placed in relation to the ground, and the ground is elsewhere: the terrain was "
                    "changed afterwards, or there is none there.",
                    "Place it anew (dbbuild place).", "placement_file.md 2"},
};

// Whoever adds a code to issue_code.h must describe it here, at the same place.
constexpr bool inOrder() {
  constexpr std::array kCodes = {
#define DELTAZ_LIST(name, text) IssueCode::name,
      DELTAZ_ISSUE_CODES(DELTAZ_LIST)
#undef DELTAZ_LIST
  };
  if (kCodes.size() != kRegistry.size()) return false;
  for (std::size_t i = 0; i < kCodes.size(); ++i) {
    if (kRegistry[i].code != kCodes[i]) return false;
  }
  return true;
}
static_assert(inOrder(), "the registry must have every issue code once, in order");

}  // namespace

std::span<const CodeDescription> codeRegistry() {
  return kRegistry;
}

const CodeDescription& describe(IssueCode code) {
  assert(code != IssueCode::kNone);
  return kRegistry[static_cast<std::size_t>(code) - 1];
}

}  // namespace deltaz
