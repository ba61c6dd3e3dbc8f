// SPDX-License-Identifier: MIT
#include "orbitutte/report/batch_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "orbitutte/errors.h"
#include "orbitutte/io/csv.h"
#include "orbitutte/page/batch_page.h"

namespace orbitutte::batch_record_test {
namespace {

JobRecord some_record() {
  JobRecord record;
  record.job = *rc::gen::inRange(0, 1000);
  record.name = *rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange('a', 'z')));
  record.mesh = record.name + ".off";
  record.options = {"--orbifold=432"};
  record.outcome = *rc::gen::element(JobOutcome::certified, JobOutcome::crashed, JobOutcome::unsuitable_mesh);
  if (record.outcome == JobOutcome::crashed)
    record.signal = 9;
  else
    record.exit_code = 3;
  record.attempts = *rc::gen::inRange(1, 3);
  record.seconds = *rc::gen::inRange(0, 1000) / 7.0;
  record.message = *rc::gen::container<std::string>(rc::gen::element('a', '"', '\n', ',', '<', '\\'));
  if (record.outcome == JobOutcome::certified)
    record.numbers = JobNumbers{"432", {1, 2, 3}, 10, 16, 0.25, 0.5, 0};
  return record;
}

RC_GTEST_PROP(BatchRecord, ReadsBackWhatItWrote, ()) {
  const JobRecord record = some_record();
  const std::string line = record_line(record);
  RC_ASSERT(line.find('\n') == line.size() - 1);
  const std::vector<JobRecord> read = parse_records(line + line);
  RC_ASSERT(read.size() == 2U);
  RC_ASSERT(record_line(read[1]) == line);
  RC_ASSERT(read[0].seconds == record.seconds);
}

RC_GTEST_PROP(BatchRecord, ALineThatWasCutShortIsNoRecord, ()) {
  const std::string line = record_line(some_record());
  const std::size_t length = *rc::gen::inRange<std::size_t>(0, line.size());
  RC_ASSERT(parse_records(line + line.substr(0, length)).size() == 1U);
}

TEST(BatchRecord, OtherLinesAreRefused) {
  EXPECT_THROW(parse_records("{}\n"), MeshError);
  EXPECT_THROW(parse_records("something\n"), MeshError);
}

TEST(BatchRecord, NumbersOfAReport) {
  const JobNumbers numbers = numbers_of_report(
      R"({"mesh": {"vertices": 10, "faces": 16}, "orbifold": {"signature": "432"}, "cones": [{"vertex": 7}],
          "distortion": {"sigma": 0.5, "within_4": 0.75, "below_64": null}})");
  EXPECT_EQ(numbers.orbifold, "432");
  EXPECT_THAT(numbers.cones, testing::ElementsAre(7));
  EXPECT_EQ(numbers.faces, 16);
  EXPECT_EQ(numbers.within_4, 0.75);
  EXPECT_TRUE(std::isnan(numbers.below_64));
  EXPECT_THROW(numbers_of_report("{}"), MeshError);
}

RC_GTEST_PROP(BatchRecord, TheTableHasARowForEachJob, ()) {
  const std::vector<JobRecord> records = {some_record(), some_record()};
  const std::vector<CsvRow> rows = read_csv(summary_csv(records));
  RC_ASSERT(rows.size() == 3U);
  RC_ASSERT(rows[1].cells.size() == rows[0].cells.size());
  RC_ASSERT(rows[2].cells[1] == records[1].name);
  RC_ASSERT(rows[2].cells.back() == records[1].message);
}

TEST(BatchPage, LinksTheFilesOfWhatWasEmbeddedAndShowsTextAsText) {
  JobRecord good, bad;
  good.name = "a b";
  good.numbers = JobNumbers{"*432", {}, 10, 1234, 0.25, 0.5, 0};
  bad.name = "c";
  bad.outcome = JobOutcome::unsuitable_mesh;
  bad.exit_code = 3;
  bad.message = "<b> & {{name}}";
  const std::string page = batch_page({good, bad}, 0);
  EXPECT_THAT(page, testing::HasSubstr("href=\"a%20b.ply\""));
  EXPECT_THAT(page, testing::HasSubstr("1,234"));
  EXPECT_THAT(page, testing::Not(testing::HasSubstr("c.ply")));
  EXPECT_THAT(page, testing::HasSubstr("unsuitable mesh (exit code 3)"));
  EXPECT_THAT(page, testing::Not(testing::HasSubstr("have not run yet")));
  EXPECT_THAT(batch_page({good, bad}, 5), testing::HasSubstr("5 have not run yet"));
  EXPECT_THAT(page, testing::HasSubstr("&lt;b&gt; &amp; {{name}}"));
}

}  // namespace
}  // namespace orbitutte::batch_record_test
