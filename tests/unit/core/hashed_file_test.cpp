#include "core/hashed_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/unit/core/temporary_folder.h"

namespace saccade::core {
namespace {

std::vector<std::uint8_t> bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Whatever pieces it was written in, across the buffer's border too.
TEST(HashedFile, EndsWithTheHashOfWhatComesBefore) {
  const tests::TemporaryFolder folder;
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, HashedFile::kPiece - 4,
                                 HashedFile::kPiece + 7, 3 * HashedFile::kPiece}) {
    const std::filesystem::path file = folder.path() / std::to_string(size);
    std::vector<std::uint8_t> content(size);
    for (std::size_t i = 0; i < size; ++i) content[i] = static_cast<std::uint8_t>(i * 31 % 251);
    HashedFile out(file);
    out.number(std::uint32_t{7});
    out.raw(content);
    EXPECT_FALSE(std::filesystem::exists(file)) << "nothing is there before commit";
    out.commit();

    std::vector<std::uint8_t> written = bytesOf(file);
    ASSERT_EQ(written.size(), sizeof(std::uint32_t) + size + sizeof(std::uint64_t));
    std::uint64_t hash = 0;
    std::memcpy(&hash, &written[written.size() - sizeof hash], sizeof hash);
    written.erase(written.end() - sizeof hash, written.end());
    EXPECT_EQ(HashedFile::hashOf(written), hash) << size;
    EXPECT_TRUE(std::equal(content.begin(), content.end(), written.begin() + sizeof(std::uint32_t)));
    written[written.size() / 2] ^= 1;
    EXPECT_NE(HashedFile::hashOf(written), hash) << size;
  }
}

}  // namespace
}  // namespace saccade::core
