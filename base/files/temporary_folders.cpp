#include "base/files/temporary_folders.h"

#include <unistd.h>

#include <map>
#include <mutex>
#include <system_error>

namespace glidelab::base {
namespace fs = std::filesystem;
namespace {

/// One per process, as signals are; never destroyed, because threads may outlive main().
struct PassingFolders {
  std::mutex mutex;
  std::map<fs::path, std::vector<fs::path>> folders;  ///< and the parents that were made for each
  bool publishing = false;
};

PassingFolders& passing() {
  static PassingFolders& all = *new PassingFolders;
  return all;
}

}  // namespace

void remember_temporary_folder(const fs::path& folder, const std::vector<fs::path>& parents) {
  const std::lock_guard lock(passing().mutex);
  passing().folders.insert_or_assign(folder, parents);
}

void forget_temporary_folder(const fs::path& folder) {
  const std::lock_guard lock(passing().mutex);
  passing().folders.erase(folder);
}

void remove_empty_folders(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) ::rmdir(folder.c_str());
}

void begin_publishing() {
  const std::lock_guard lock(passing().mutex);
  passing().publishing = true;
}

bool discard_temporary_folders() {
  passing().mutex.lock();  // held until the process ends if something is removed
  if (passing().publishing) {
    passing().mutex.unlock();
    return false;
  }
  for (const auto& [folder, parents] : passing().folders) {
    std::error_code ignored;  // what another thread writes in the meantime stays, as after a kill
    fs::remove_all(folder, ignored);
    remove_empty_folders(parents);
  }
  return true;
}

}  // namespace glidelab::base
