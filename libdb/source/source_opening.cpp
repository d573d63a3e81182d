#include "libdb/source/source_opening.h"

#include <algorithm>
#include <cctype>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <span>
#include <string_view>

#include "libdb/source/gdal_session.h"
#include "libdb/source/source_error.h"

namespace deltaz {

namespace {

bool endsIn(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && std::equal(end.rbegin(), end.rend(), text.rbegin(), [](char a, char b) {
           return a == std::tolower(static_cast<unsigned char>(b));
         });
}

bool isRaster(const std::string& path) {
  return GDALIdentifyDriverEx(path.c_str(), GDAL_OF_RASTER, nullptr, nullptr) != nullptr;
}

// Virtual paths (/vsizip/...) name archives, whose members the plain checks of a file do not apply to.
bool isVirtual(const std::string& path) {
  return path.starts_with("/vsi");
}

Status checkFile(const std::string& path) {
  VSIStatBufL status;
  if (VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG | VSI_STAT_NATURE_FLAG | VSI_STAT_SIZE_FLAG) !=
      0)
    return accessError(path, "cannot open the source", "there is no such file");
  if (VSI_ISDIR(status.st_mode)) {
    if (isVirtual(path)) return Success{};
    return refusedSource(path, "a folder is not a source", {}, "Name the files in it");
  }
  if (!VSI_ISREG(status.st_mode))
    return refusedSource(path, "the source is not a regular file", {}, "Copy it into one");
  if (status.st_size == 0) return refusedSource(path, "the source is empty", "the file has no bytes");
  VSILFILE* readable = VSIFOpenL(path.c_str(), "rb");
  if (readable == nullptr)
    return accessError(path, "cannot open the source", "it cannot be read", "Check its permissions");
  VSIFCloseL(readable);
  return Success{};
}

std::vector<std::string> rastersInArchive(const std::string& folder) {
  const CPLStringList names(VSIReadDirRecursive(folder.c_str()));
  std::vector<std::string> found;
  for (int i = 0; i < names.size(); ++i) {
    const std::string candidate = folder + "/" + names[i];
    VSIStatBufL status;
    if (VSIStatL(candidate.c_str(), &status) != 0 || !VSI_ISREG(status.st_mode)) continue;
    if (isRaster(candidate)) found.push_back(candidate);
  }
  std::sort(found.begin(), found.end());
  return found;
}

Status addFile(const std::string& path, StreamingHash& hash) {
  VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
  if (file == nullptr) return accessError(path, "cannot read the source");
  std::vector<std::byte> buffer(1 << 20);
  for (;;) {
    const std::size_t count = VSIFReadL(buffer.data(), 1, buffer.size(), file);
    hash.update(std::span(buffer).first(count));
    if (count < buffer.size()) break;
  }
  VSIFCloseL(file);
  return Success{};
}

}  // namespace

Result<std::vector<std::string>> rastersBehind(const std::string& path) {
  const GdalSession session;  // the drivers must be there to be asked
  DELTAZ_TRY(checkFile(path));
  if (isRaster(path)) return std::vector<std::string>{path};
  const bool archive = endsIn(path, ".zip");
  VSIStatBufL status;
  const bool folder = isVirtual(path) && VSIStatL(path.c_str(), &status) == 0 && VSI_ISDIR(status.st_mode);
  if (!archive && !folder) return std::vector<std::string>{path};  // opening it says what is wrong
  std::vector<std::string> inside = rastersInArchive(archive && !isVirtual(path) ? "/vsizip/" + path : path);
  if (inside.empty()) return refusedSource(path, "there is no raster in the archive that can be read");
  return inside;
}

Result<Hash128> hashOfContent(const std::string& path, const std::vector<std::string>& members) {
  StreamingHash hash;
  DELTAZ_TRY(addFile(path, hash));
  for (const std::string& member : members) {
    VSIStatBufL status;
    const bool is_file = VSIStatL(member.c_str(), &status) == 0 && VSI_ISREG(status.st_mode);
    if (is_file && path != member) DELTAZ_TRY(addFile(member, hash));
  }
  return hash.digest();
}

}  // namespace deltaz
