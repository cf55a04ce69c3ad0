// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/database_owner.hpp"

#include "tests/scenarios/testing.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tumble::scenarios {
namespace {

class DatabaseOwnerTest : public test::TemporaryFolder {
 protected:
  fs::path database() const { return folder_ / "results.db"; }
  fs::path lock() const { return folder_ / "results.db.lock"; }
  std::string complaint(const fs::path& path) const {
    return test::complaint([&] { const DatabaseOwner owner(path); });
  }
};

/// Holder is a child process that owns the database until it is killed.
class Holder {
 public:
  explicit Holder(const fs::path& database) {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    pid_ = fork();
    if (pid_ == 0) {
      const DatabaseOwner owner(database);
      if (write(ends[1], "x", 1) != 1) _exit(1);
      while (true) pause();
    }
    close(ends[1]);
    char ready = 0;
    EXPECT_EQ(read(ends[0], &ready, 1), 1);
    close(ends[0]);
  }
  ~Holder() { kill(); }
  void kill() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
};

TEST_F(DatabaseOwnerTest, IsOneAtATime) {
  {
    const DatabaseOwner owner(database());
    EXPECT_TRUE(fs::exists(lock()));
    EXPECT_THAT(complaint(database()), HasSubstr("results.db: process " + std::to_string(getpid()) + " on "));
    EXPECT_EQ(complaint(folder_ / "other.db"), "") << "of its own file alone";
  }
  EXPECT_FALSE(fs::exists(lock()));
  EXPECT_EQ(complaint(database()), "");
}

TEST_F(DatabaseOwnerTest, IsKnownUnderEveryName) {
  write("results.db", "");
  fs::create_symlink("results.db", folder_ / "link.db");
  const DatabaseOwner owner(database());
  EXPECT_THAT(complaint(folder_ / "link.db"), HasSubstr("is writing to this database"));
}

TEST_F(DatabaseOwnerTest, AKilledOneLeavesItToTheNext) {
  Holder holder(database());
  EXPECT_THAT(complaint(database()), HasSubstr("process " + std::to_string(holder.pid()) + " on "));
  EXPECT_THAT(complaint(database()), HasSubstr(" since 20"));
  holder.kill();
  ASSERT_TRUE(fs::exists(lock())) << "left behind, and held by nobody";
  EXPECT_EQ(complaint(database()), "");
  EXPECT_FALSE(fs::exists(lock()));
}

TEST_F(DatabaseOwnerTest, AFolderThatIsNotThereIsBadInput) {
  EXPECT_THAT(complaint(folder_ / "no" / "results.db"), HasSubstr("cannot be locked"));
}

}  // namespace
}  // namespace tumble::scenarios
