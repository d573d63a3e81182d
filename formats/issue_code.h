// The codes under which damage and disagreement in a database are reported. A code is never reused and never
// renamed; a retired one stays listed. The long explanations are in libdb/check/code_registry.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace deltaz {

// Families: IO files, HDR headers and footers, IDX block index, SUM checksums, MAN area.json, REF node
// references, TILE node record against its terrain, HGT heights, ERR stored errors, SRC database against
// source, COL colour maps, MDL models, PLC placements.
#define DELTAZ_ISSUE_CODES(X)                    \
  X(kIoCannotRead, "IO_CANNOT_READ")             \
  X(kIoMissingFile, "IO_MISSING_FILE")           \
  X(kIoUnreferencedFile, "IO_UNREFERENCED_FILE") \
  X(kHdrMagic, "HDR_MAGIC")                      \
  X(kHdrVersionNewer, "HDR_VERSION_NEWER")       \
  X(kHdrFeatureUnknown, "HDR_FEATURE_UNKNOWN")   \
  X(kHdrField, "HDR_FIELD")                      \
  X(kHdrChecksum, "HDR_CHECKSUM")                \
  X(kHdrLength, "HDR_LENGTH")                    \
  X(kHdrFooter, "HDR_FOOTER")                    \
  X(kIdxChecksum, "IDX_CHECKSUM")                \
  X(kIdxOrder, "IDX_ORDER")                      \
  X(kSumBlock, "SUM_BLOCK")                      \
  X(kSumFileId, "SUM_FILE_ID")                   \
  X(kSumPadding, "SUM_PADDING")                  \
  X(kManHash, "MAN_HASH")                        \
  X(kManSyntax, "MAN_SYNTAX")                    \
  X(kManField, "MAN_FIELD")                      \
  X(kManFileMismatch, "MAN_FILE_MISMATCH")       \
  X(kRefRange, "REF_RANGE")                      \
  X(kRefCycle, "REF_CYCLE")                      \
  X(kRefUnreachable, "REF_UNREACHABLE")          \
  X(kRefChild, "REF_CHILD")                      \
  X(kRefRecord, "REF_RECORD")                    \
  X(kRefData, "REF_DATA")                        \
  X(kRefMissing, "REF_MISSING")                  \
  X(kTileGrid, "TILE_GRID")                      \
  X(kTileHeightRange, "TILE_HEIGHT_RANGE")       \
  X(kTileVoids, "TILE_VOIDS")                    \
  X(kTileSphere, "TILE_SPHERE")                  \
  X(kTileCone, "TILE_CONE")                      \
  X(kTileNormal, "TILE_NORMAL")                  \
  X(kTileLod, "TILE_LOD")                        \
  X(kHgtDecode, "HGT_DECODE")                    \
  X(kHgtSubset, "HGT_SUBSET")                    \
  X(kHgtRing, "HGT_RING")                        \
  X(kHgtBorder, "HGT_BORDER")                    \
  X(kHgtPatches, "HGT_PATCHES")                  \
  X(kHgtSeam, "HGT_SEAM")                        \
  X(kErrGeometric, "ERR_GEOMETRIC")              \
  X(kErrRms, "ERR_RMS")                          \
  X(kErrAncestor, "ERR_ANCESTOR")                \
  X(kErrCoverage, "ERR_COVERAGE")                \
  X(kSrcHeight, "SRC_HEIGHT")                    \
  X(kSrcVoid, "SRC_VOID")                        \
  X(kSrcExtent, "SRC_EXTENT")                    \
  X(kSrcGeoreference, "SRC_GEOREFERENCE")        \
  X(kColorTree, "COL_TREE")                      \
  X(kColorTile, "COL_TILE")                      \
  X(kColorBorder, "COL_BORDER")                  \
  X(kColorFilter, "COL_FILTER")                  \
  X(kModelTree, "MDL_TREE")                      \
  X(kModelMesh, "MDL_MESH")                      \
  X(kModelSphere, "MDL_SPHERE")                  \
  X(kModelError, "MDL_ERROR")                    \
  X(kModelLod, "MDL_LOD")                        \
  X(kModelTransform, "MDL_TRANSFORM")            \
  X(kPlacementRecord, "PLC_RECORD")              \
  X(kPlacementSphere, "PLC_SPHERE")              \
  X(kPlacementGround, "PLC_GROUND")

enum class IssueCode : std::uint16_t {
  kNone,
#define DELTAZ_DECLARE(name, text) name,
  DELTAZ_ISSUE_CODES(DELTAZ_DECLARE)
#undef DELTAZ_DECLARE
};

// "SUM_BLOCK" for kSumBlock, "NONE" for kNone.
std::string_view issueCodeName(IssueCode code);

// The inverse of issueCodeName; nothing for an unknown name.
std::optional<IssueCode> issueCodeFromName(std::string_view name);

}  // namespace deltaz
