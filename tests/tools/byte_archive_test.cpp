#include "tools/byte_archive.h"

#include <gtest/gtest.h>
#include <limits>

namespace signorini::tools {

struct Leaf {
  double number = 0.0;
  std::string text;
  bool operator==(const Leaf&) const = default;
};
void visit_fields(auto& archive, Reflects<Leaf> auto& leaf) {
  archive(leaf.number, leaf.text);
}

struct Tree {
  std::vector<Leaf> leaves;
  std::optional<Leaf> fruit;
  std::map<std::string, long> counts;
  std::array<int, 3> triple = {};
  std::vector<std::vector<double>> rows;
  bool operator==(const Tree&) const = default;
};
void visit_fields(auto& archive, Reflects<Tree> auto& tree) {
  archive(tree.leaves, tree.fruit, tree.counts, tree.triple, tree.rows);
}

namespace {

Tree sample() {
  return {.leaves = {{1.5, "a"}, {std::numeric_limits<double>::infinity(), std::string(3, '\0')}},
          .fruit = Leaf{-0.0, ""},
          .counts = {{"x", 7}, {"", -1}},
          .triple = {1, 2, 3},
          .rows = {{}, {1.0, 2.0}}};
}

TEST(ByteArchive, WhatWasWrittenIsRead) {
  EXPECT_EQ(from_bytes<Tree>(to_bytes(sample())), sample());
  EXPECT_EQ(from_bytes<Tree>(to_bytes(Tree{})), Tree{});
}

TEST(ByteArchive, EveryCutIsRefused) {
  const std::string bytes = to_bytes(sample());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THROW((void)from_bytes<Tree>(std::string_view(bytes).substr(0, length)),
                 std::runtime_error)
        << length;
  }
  EXPECT_THROW((void)from_bytes<Tree>(bytes + "x"), std::runtime_error);
}

TEST(ByteArchive, ACountBeyondTheBytesIsRefusedBeforeMemoryIsAsked) {
  EXPECT_THROW((void)from_bytes<std::vector<double>>(to_bytes(std::uint64_t{1} << 60U)),
               std::runtime_error);
}

}  // namespace
}  // namespace signorini::tools
