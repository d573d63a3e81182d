// Puts a database in place: the target is absent or complete, whatever happens on the way.
//
// A new database is made in `.NAME.dz.tmp-...` beside the target and moved there in one step that never
// replaces. An overwrite writes files under new, generation-named names into the folder and then swaps
// area.json. Left-over temporary folders of processes that died are swept. One writer at a time: the lock is
// a file in the folder.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "formats/area.h"
#include "formats/error.h"
#include "formats/file_system.h"

namespace deltaz {

// What would be refused at once: the target exists (kUsage), or with `overwrite` is not a deltaz database
// (kUsage); its folder is missing (kCannotAccess).
Status checkTarget(const FileSystem& files, const std::string& target, bool overwrite);

// Removes the files in the folder of the database at `target` that carry a name of ours and that area.json
// does not list, and left-overs of edits that died. Returns their names. kCannotAccess if a writer is at
// work; kInvalid if it is no database or a damaged one.
Result<std::vector<std::string>> removeUnlisted(const FileSystem& files, const std::string& target);

class Publication {
 public:
  static Result<Publication> begin(const FileSystem& files, const std::string& target, bool overwrite);
  // Starts an edit of the database at `target`: new files are added to it and area.json is swapped, nothing
  // else is touched. Files no longer listed stay, for readers that still have the old state open, until
  // removeUnlisted. kCannotAccess if another writer is at work.
  static Result<Publication> beginEdit(const FileSystem& files, const std::string& target);
  Publication(Publication&&) noexcept;
  Publication& operator=(Publication&&) = delete;
  // Removes what was written unless publish() succeeded.
  ~Publication();

  // Where to create a new file called `name`; it is removed again unless published.
  std::string newFilePath(const std::string& name);
  // Number of this state of the database; part of the names of its files.
  std::uint64_t generation() const { return generation_; }
  // Of an edit: the header as it stands, looked at under the lock.
  const AreaHeader& area() const { return area_; }
  // Writes area.json and makes it all durable and visible. Sets area.generation. Once. If the very last step,
  // syncing the folder the target stands in, fails, the error says so although the target is there and
  // complete.
  Status publish(AreaHeader& area);

 private:
  Publication(const FileSystem& files, std::string target) : files_(&files), target_(std::move(target)) {}
  Status beginNew();
  Status beginOverwrite();
  Status writeArea(const std::string& name, const AreaHeader& area);

  const FileSystem* files_;
  std::string target_;
  std::string folder_;  // where files are written: temporary or the target itself
  bool replaces_ = false;
  bool edits_ = false;
  AreaHeader area_;
  bool done_ = false;
  bool made_folder_ = false;
  std::uint64_t generation_ = 1;
  std::vector<std::string> new_names_;  // written by us into folder_
  std::unique_ptr<FileLock> lock_;
};

}  // namespace deltaz
