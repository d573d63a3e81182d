// A place to make a database in several steps, each an edit of the one before, so that what people see
// changes once: the target is absent or complete, and with `overwrite` the old state or the new one, whatever
// happens on the way.
//
// The steps work on a database in a temporary folder beside the target. A new target is put in place by one
// rename; into an existing one the files move under names of a new generation, and its area.json is swapped
// (publication.h). Left-over folders of processes that died are swept by the next one that makes the same
// target.
#pragma once

#include <memory>
#include <string>

#include "formats/error.h"
#include "formats/file_system.h"

namespace deltaz {

class StagedDatabase {
 public:
  // Errors as checkTarget; kCannotAccess if the temporary folder cannot be made.
  static Result<StagedDatabase> begin(const FileSystem& files, const std::string& target, bool overwrite);
  StagedDatabase(StagedDatabase&&) noexcept;
  StagedDatabase& operator=(StagedDatabase&&) = delete;
  // Removes what was made unless it was published.
  ~StagedDatabase();

  // Where the steps make the database.
  const std::string& path() const { return path_; }
  // Puts it in place of the target. Once.
  Status publish();

 private:
  StagedDatabase(const FileSystem& files, std::string target, bool overwrite)
      : files_(&files), target_(std::move(target)), overwrite_(overwrite) {}
  Status moveInto();

  const FileSystem* files_;
  std::string target_;
  bool overwrite_;
  std::string folder_;  // temporary; empty once it is gone
  std::string path_;
  std::unique_ptr<FileLock> lock_;
};

}  // namespace deltaz
