// SPDX-License-Identifier: MIT
#include "orbitutte/io/manifest.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "orbitutte/errors.h"
#include "orbitutte/io/csv.h"

namespace orbitutte::manifest_test {
namespace {

using Kind = ManifestColumn::Kind;
using Table = std::vector<std::vector<std::string>>;

const std::vector<ManifestColumn> columns = {
    {"orbifold"}, {"cones"}, {"clamp"}, {"floor", Kind::flag}, {"weights-file", Kind::file}};

std::string csv_of(const Table& table, const std::string& line_break) {
  std::string text;
  for (const std::vector<std::string>& row : table) {
    for (std::size_t k = 0; k < row.size(); ++k) text += (k > 0 ? "," : "") + csv_cell(row[k]);
    text += line_break;
  }
  return text;
}

// The message of the exception that a manifest causes.
std::string refusal(const std::string& text) {
  try {
    parse_manifest(text, columns);
  } catch (const ArgumentError& error) {
    return error.what();
  }
  return "none";
}

// Cells with what tables have trouble with.
rc::Gen<std::string> some_cell() {
  return rc::gen::container<std::string>(
      rc::gen::element('a', 'b', ' ', ',', ';', '"', '\n', '\t', '1', '*'));
}

RC_GTEST_PROP(Csv, ReadsBackWhatItWrote, ()) {
  const auto width = *rc::gen::inRange(1, 5);
  auto table = *rc::gen::container<Table>(rc::gen::container<std::vector<std::string>>(width, some_cell()));
  std::vector<std::string> header(width, "column");
  table.insert(table.begin(), header);
  const auto line_break = *rc::gen::element<std::string>("\n", "\r\n");
  const std::vector<CsvRow> rows = read_csv(csv_of(table, line_break));
  const auto is_blank = [](const std::vector<std::string>& row) {
    return std::all_of(row.begin(), row.end(), [](const std::string& cell) { return cell.empty(); });
  };
  std::erase_if(table, is_blank);
  RC_ASSERT(rows.size() == table.size());
  for (std::size_t r = 0; r < rows.size(); ++r) RC_ASSERT(rows[r].cells == table[r]);
}

RC_GTEST_PROP(Csv, NeverDoesAnythingButReadOrRefuse, ()) {
  const auto text = *some_cell();
  try {
    read_csv(text);
  } catch (const ArgumentError&) {
  }
}

TEST(Csv, TakesSemicolonsTabsAndAByteOrderMark) {
  EXPECT_EQ(read_csv("\xEF\xBB\xBFmesh;cones\nx.obj;1,2,3\n")[1].cells,
            (std::vector<std::string>{"x.obj", "1,2,3"}));
  EXPECT_EQ(read_csv("mesh\tcones\nx.obj\t1,2,3")[1].cells, (std::vector<std::string>{"x.obj", "1,2,3"}));
  EXPECT_EQ(read_csv("mesh\n\n\n x.obj \n")[1].line, 4);
}

TEST(Csv, NamesTheLineOfAFault) {
  EXPECT_THAT([] { read_csv("a,b\n\"1\n2,3"); },
              testing::ThrowsMessage<ArgumentError>(testing::StartsWith("line 2: a quote is not closed")));
  EXPECT_THAT([] { read_csv("a,b\n\"1\" 2,3"); },
              testing::ThrowsMessage<ArgumentError>(testing::StartsWith("line 2: '2' follows")));
}

TEST(Manifest, GivesEachRowAsOptionsOfEmbed) {
  const auto jobs = parse_manifest(
      "mesh,orbifold,cones,floor,name\nmeshes/a.off,432,\"1,2,3\",yes,first\nb.ply.gz,,best,no,\n", columns);
  ASSERT_EQ(jobs.size(), 2U);
  EXPECT_EQ(jobs[0].name, "first");
  EXPECT_EQ(jobs[0].mesh, "meshes/a.off");
  EXPECT_EQ(jobs[0].options, (std::vector<std::string>{"--orbifold=432", "--cones=1,2,3", "--floor"}));
  EXPECT_EQ(jobs[1].name, "b");
  EXPECT_EQ(jobs[1].options, (std::vector<std::string>{"--cones=best"}));
  EXPECT_EQ(jobs[1].line, 3);
}

TEST(Manifest, PathsAreRelativeToAFolder) {
  BatchJob job = {"x", "a.off", {"--weights-file=w.txt", "--orbifold=432"}, 2};
  job = in_folder(job, columns, "data");
  EXPECT_EQ(job.mesh, "data/a.off");
  EXPECT_EQ(job.options[0], "--weights-file=data/w.txt");
  EXPECT_EQ(job.options[1], "--orbifold=432");
  EXPECT_EQ(in_folder({"x", "/a.off", {}, 2}, columns, "data").mesh, "/a.off");
}

TEST(Manifest, FaultsNameRowAndColumn) {
  EXPECT_THAT(refusal("mesh,cone\na.off,1"), testing::HasSubstr("line 1: 'cone' is no column"));
  EXPECT_THAT(refusal("orbifold\n432"), testing::HasSubstr("no column is named 'mesh'"));
  EXPECT_THAT(refusal("mesh,mesh\na,b"), testing::HasSubstr("two columns are named 'mesh'"));
  EXPECT_THAT(refusal("mesh,floor\na.off,no\nb.off,maybe"),
              testing::StartsWith("line 3 (job 1), column 'floor': 'maybe' is neither yes nor no"));
  EXPECT_THAT(refusal("mesh,cones\na.off,1,2,3"),
              testing::AllOf(testing::StartsWith("line 2 (job 0)"), testing::HasSubstr("into quotes")));
  EXPECT_THAT(refusal("mesh,cones\na.off"), testing::StartsWith("line 2 (job 0), there are 1 cells"));
  EXPECT_THAT(refusal("mesh,cones\n,1"),
              testing::StartsWith("line 2 (job 0), column 'mesh': the cell is empty"));
  EXPECT_THAT(refusal("mesh,name\na.off,../b"),
              testing::HasSubstr("column 'name': '../b' cannot name files"));
  EXPECT_THAT(refusal("mesh,name\na.off,b\nc.off,b"),
              testing::AllOf(testing::StartsWith("line 3 (job 1), column 'name'"),
                             testing::HasSubstr("line 2 (job 0)")));
  EXPECT_THAT(refusal(""), testing::HasSubstr("empty"));
  EXPECT_THAT(refusal("mesh\n"), testing::HasSubstr("no jobs"));
}

RC_GTEST_PROP(Manifest, NamesAreDistinctAndDoNotChangeIfAJobIsAdded, ()) {
  const auto meshes = *rc::gen::container<std::vector<std::string>>(
      rc::gen::element<std::string>("a.off", "b/a.off", "a-2.obj", "c/a.ply.gz", "a-3.off", ".off"));
  const std::vector<BatchJob> jobs = jobs_of_meshes(meshes);
  std::set<std::string> names;
  for (const BatchJob& job : jobs) names.insert(job.name);
  RC_ASSERT(names.size() == meshes.size());
  std::vector<std::string> more = meshes;
  more.emplace_back("a.off");
  const std::vector<BatchJob> longer = jobs_of_meshes(more);
  for (std::size_t k = 0; k < jobs.size(); ++k) RC_ASSERT(longer[k].name == jobs[k].name);
}

}  // namespace
}  // namespace orbitutte::manifest_test
