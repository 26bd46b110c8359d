// SPDX-License-Identifier: Apache-2.0
// Files that launches leave on a host: which of them a sweep removes, and which belong to somebody alive that it cannot
// see.
#include "coordinator/launch/own_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>

#include "common/base/files/atomic_file.h"
#include "common/base/host.h"
#include "common/runs/run_files.h"
#include "coordinator/launch/attempt_folders.h"
#include "coordinator/launch/sweep.h"
#include "coordinator/run/folder_lock.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

/// Number of no process on this host, as that of a process in another container looks.
constexpr const char* kNoProcess = "4194305";

class Sweep : public testing::Test {
  protected:
    void SetUp() override { setenv("TMPDIR", folder.c_str(), 1); }
    void TearDown() override { unsetenv("TMPDIR"); }

    const fs::path folder = test::fresh_test_folder();
};

/// A child that makes an OwnFolder and waits to be killed.
class Owner {
  public:
    explicit Owner(const fs::path& parent) {
        int ends[2];
        EXPECT_EQ(pipe(ends), 0);
        pid_ = fork();
        if (pid_ == 0) {
            const OwnFolder own(parent);
            if (write(ends[1], own.path().c_str(), own.path().string().size()) < 0) _exit(1);
            pause();
        }
        char name[4096];
        const ssize_t length = read(ends[0], name, sizeof name);
        path_ = std::string(name, static_cast<std::size_t>(std::max<ssize_t>(0, length)));
        close(ends[0]);
        close(ends[1]);
    }
    ~Owner() { end(); }
    void end() {
        if (pid_ <= 0) return;
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
        pid_ = 0;
    }
    const fs::path& path() const { return path_; }

  private:
    pid_t pid_ = 0;
    fs::path path_;
};

TEST_F(Sweep, AFolderIsDeadIfNobodyHoldsItsLockWhateverItsNumber) {
    const OwnFolder own(folder);
    // The number of a process in another container is nobody's here.
    const fs::path living = folder / (std::string(kOwnFolderName) + kNoProcess + "-abc");
    fs::rename(own.path(), living);
    Owner killed(folder);
    ASSERT_TRUE(fs::exists(killed.path()));
    sweep();
    EXPECT_TRUE(fs::exists(living));
    EXPECT_TRUE(fs::exists(killed.path()));
    killed.end();
    // And a dead one's number may be somebody else's.
    const fs::path dead = folder / (std::string(kOwnFolderName) + std::to_string(getpid()) + "-abc");
    fs::rename(killed.path(), dead);
    EXPECT_GE(sweep(), 1);
    EXPECT_TRUE(fs::exists(living));
    EXPECT_FALSE(fs::exists(dead));
    fs::remove(living);
}

TEST_F(Sweep, ASegmentOfSharedMemoryIsDeadIfNobodyMapsIt) {
    const fs::path segment =
        shared_memory_folder() /
        ("vader_segment." + host_name() + "." + std::to_string(geteuid()) + ".sweep_test" + std::to_string(getpid()));
    const int file = open(segment.c_str(), O_RDWR | O_CREAT | O_EXCL, 0600);
    ASSERT_GE(file, 0);
    ASSERT_EQ(ftruncate(file, 4096), 0);
    void* const memory = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    ASSERT_NE(memory, MAP_FAILED);
    close(file);
    sweep();
    EXPECT_TRUE(fs::exists(segment));
    munmap(memory, 4096);
    sweep();
    EXPECT_FALSE(fs::exists(segment));
    fs::remove(segment);
}

TEST_F(Sweep, TheKeyOfAKilledLaunchIsRemovedFromItsRunDirectory) {
    const fs::path run = folder / "run", key = run / kLaunchFolder / "key";
    fs::create_directories(key.parent_path());
    test::write_file(key, "secret");
    const auto die = [&](const fs::path& file) {
        Owner killed(folder);
        fs::create_symlink(file, killed.path() / "key");
        killed.end();
        sweep();
        EXPECT_FALSE(fs::exists(killed.path()));
    };
    {
        const FolderLock other(key.parent_path(), 0.0, nullptr);  // of a launch that goes on in this folder
        die(key);
        EXPECT_TRUE(fs::exists(key));
    }
    die(key);
    EXPECT_FALSE(fs::exists(key));
    test::write_file(run / "key", "of something else");
    die(run / "key");
    EXPECT_TRUE(fs::exists(run / "key"));
}

TEST_F(Sweep, FoldersOfAnAttemptAreMadeAgainAndSharedMemoryGoesElsewhereIfItMust) {
    StartPlan plan;
    plan.processes = 2;
    {
        const AttemptFolders first(plan, folder / "key");
        EXPECT_TRUE(fs::is_directory(plan.temporary));
        EXPECT_TRUE(fs::is_directory(plan.shared_memory));
        fs::remove_all(plan.temporary);
        fs::remove_all(plan.shared_memory);
    }
    {
        const AttemptFolders second(plan, folder / "key");
        EXPECT_TRUE(fs::is_directory(plan.temporary));
        EXPECT_TRUE(fs::is_directory(plan.shared_memory));
        EXPECT_EQ(fs::read_symlink(plan.temporary / "key"), folder / "key");
    }
    EXPECT_FALSE(fs::exists(plan.temporary));
    EXPECT_FALSE(fs::exists(plan.shared_memory));
    plan.processes = 1 << 24;
    const AttemptFolders crowded(plan, folder / "key");
    EXPECT_EQ(plan.shared_memory, plan.temporary);
    EXPECT_NE(crowded.trouble().find("has no room"), std::string::npos);
}

TEST_F(Sweep, AFolderThatCannotBeMadeSaysWhy) {
    const fs::path gone = folder / "gone";
    try {
        const OwnFolder own(gone);
        FAIL();
    } catch (const FileError& error) {
        EXPECT_EQ(error.code(), ENOENT);
        EXPECT_EQ(error.what(), gone.string() + ": no folder can be made in it (No such file or directory)");
    }
    EXPECT_THROW(probe_folder(gone), FileError);
}

}  // namespace
}  // namespace treefarm
