#include "base/files/passing_folders.h"

#include <mutex>
#include <set>
#include <system_error>

namespace glidelab::base {
namespace fs = std::filesystem;
namespace {

/// One per process, as signals are; never destroyed, because threads may outlive main().
struct PassingFolders {
  std::mutex mutex;
  std::set<fs::path> folders;
  bool publishing = false;
};

PassingFolders& passing() {
  static PassingFolders& all = *new PassingFolders;
  return all;
}

}  // namespace

void remember_passing_folder(const fs::path& folder) {
  const std::lock_guard lock(passing().mutex);
  passing().folders.insert(folder);
}

void forget_passing_folder(const fs::path& folder) {
  const std::lock_guard lock(passing().mutex);
  passing().folders.erase(folder);
}

void begin_publishing() {
  const std::lock_guard lock(passing().mutex);
  passing().publishing = true;
}

bool discard_passing_folders() {
  passing().mutex.lock();  // held until the process ends if something is removed
  if (passing().publishing) {
    passing().mutex.unlock();
    return false;
  }
  for (const fs::path& folder : passing().folders) {
    std::error_code ignored;  // what another thread writes in the meantime stays, as after a kill
    fs::remove_all(folder, ignored);
  }
  return true;
}

}  // namespace glidelab::base
