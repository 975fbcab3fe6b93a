#include <varifold/io/output_file.h>

#include <sys/stat.h>
#include <tests/io/io_support.h>
#include <tests/support/test_files.h>
#include <unistd.h>
#include <varifold/io/mapped_file.h>
#include <fstream>
#include <iterator>

namespace varifold {
namespace {

namespace fs = std::filesystem;
using test::message_of;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(OutputFile, WritesAndReplacesWholeFiles) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.file("a.txt");
  ASSERT_TRUE(write_file(path, as_bytes("one")));
  EXPECT_EQ(content(path), "one");
  ASSERT_TRUE(write_file(path, as_bytes("second")));
  EXPECT_EQ(content(path), "second");
  EXPECT_EQ(files_in(path.parent_path()), 1u);
}

TEST(OutputFile, LeavesTheOldContentUntilCommit) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.file("a.txt");
  ASSERT_TRUE(write_file(path, as_bytes("old")));
  {
    VARIFOLD_ASSERT_VALUE(file, OutputFile::create(path));
    ASSERT_TRUE(file.write(as_bytes("half of the n")));
    EXPECT_EQ(content(path), "old");
  }
  EXPECT_EQ(content(path), "old");
  EXPECT_EQ(files_in(path.parent_path()), 1u);
}

TEST(OutputFile, KeepsPermissionsAndFollowsLinks) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.file("a.txt");
  const fs::path link = folder.file("link.txt");
  ASSERT_TRUE(write_file(path, as_bytes("old")));
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("a.txt", link);
  ASSERT_TRUE(write_file(link, as_bytes("new")));
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content(path), "new");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(OutputFile, ReportsAFullDisk) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EXPECT_EQ(message_of(write_file("/dev/full", as_bytes("data"))),
            "/dev/full: No space left on device");
  EXPECT_TRUE(fs::exists("/dev/full"));
}

TEST(OutputFile, ReportsFoldersThatCannotBeWritten) {
  const test::TemporaryFolder folder;
  const fs::path missing = folder.file("no/such/file");
  EXPECT_EQ(message_of(write_file(missing, {})), missing.string() + ": No such file or directory");
  const fs::path itself = folder.file("").parent_path();
  EXPECT_EQ(message_of(write_file(itself, {})), itself.string() + ": Is a directory");
  if (::geteuid() == 0) return;  // the superuser may write anywhere
  fs::permissions(itself, fs::perms::owner_read | fs::perms::owner_exec);
  const fs::path file = folder.file("a");
  EXPECT_EQ(message_of(write_file(file, {})), file.string() + ": Permission denied");
  fs::permissions(itself, fs::perms::owner_all);
}

TEST(MappedFile, MapsFilesAndReadsPipes) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.file("a.txt");
  ASSERT_TRUE(write_file(path, as_bytes("some bytes")));
  VARIFOLD_ASSERT_VALUE(file, MappedFile::open(path));
  EXPECT_EQ(as_text(file.bytes()), "some bytes");
  const MappedFile moved = std::move(file);
  EXPECT_EQ(as_text(moved.bytes()), "some bytes");

  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  ASSERT_EQ(::write(ends[1], "through", 7), 7);
  ::close(ends[1]);
  VARIFOLD_ASSERT_VALUE(pipe, MappedFile::open("/dev/fd/" + std::to_string(ends[0])));
  EXPECT_EQ(as_text(pipe.bytes()), "through");
  ::close(ends[0]);

  ASSERT_TRUE(write_file(path, {}));
  VARIFOLD_ASSERT_VALUE(empty, MappedFile::open(path));
  EXPECT_TRUE(empty.bytes().empty());
}

TEST(MappedFile, ReportsWhatCannotBeRead) {
  EXPECT_EQ(message_of(MappedFile::open("no such file")),
            "no such file: No such file or directory");
  EXPECT_EQ(message_of(MappedFile::open("/tmp")), "/tmp: Is a directory");
  if (!fs::exists("/dev/zero")) return;
  EXPECT_EQ(message_of(MappedFile::open("/dev/zero")), "/dev/zero: Is a device");
}

}  // namespace
}  // namespace varifold
