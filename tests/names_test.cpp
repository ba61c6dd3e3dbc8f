// SPDX-License-Identifier: MIT
// The tables of names: one name for each value, one value for each name.
#include "orbitutte/names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iterator>
#include <set>

#include "orbitutte/errors.h"
#include "orbitutte/export/texture_chart.h"
#include "orbitutte/inspect/inspection.h"
#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/minimum.h"
#include "orbitutte/options.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/samples/sample.h"
#include "orbitutte/verify/theorem2.h"

namespace orbitutte::names_test {
namespace {

template <typename Enum>
class NamesOf : public testing::Test {};

using Enums =
    testing::Types<Topology, Termination, ConeKind, SeamKind, WeightKind, Spread, Backend, DefectKind,
                   WeakPlaceKind, TextureChart, SampleShape, InertiaMethod, Theorem2::Status>;
TYPED_TEST_SUITE(NamesOf, Enums);

TYPED_TEST(NamesOf, AreDifferentAndLeadBackToTheirValues) {
  std::set<TypeParam> values;
  std::set<std::string> names;
  for (const NamedValue<TypeParam>& row : NameTable<TypeParam>::rows) {
    EXPECT_EQ(name_of(row.value), row.name);
    EXPECT_EQ(find_by_name<TypeParam>(row.name), row.value);
    values.insert(row.value);
    names.insert(row.name);
  }
  EXPECT_EQ(values.size(), std::size(NameTable<TypeParam>::rows));
  EXPECT_EQ(names.size(), values.size());
  EXPECT_FALSE(names.contains(""));
  EXPECT_EQ(find_by_name<TypeParam>("nothing of the kind"), std::nullopt);
}

TYPED_TEST(NamesOf, AreParsedIfTheyMayBeAskedFor) {
  for (const NamedValue<TypeParam>& row : NameTable<TypeParam>::rows) {
    if (row.is_choice) {
      EXPECT_EQ(parse_choice<TypeParam>(row.name, "it"), row.value);
    } else {
      EXPECT_THROW(parse_choice<TypeParam>(row.name, "it"), ArgumentError);
    }
  }
}

TEST(Names, ARefusalListsTheChoices) {
  try {
    parse_choice<WeightKind>("file", "--weights");
    FAIL();
  } catch (const ArgumentError& error) {
    EXPECT_STREQ(error.what(),
                 "--weights is 'file'; it may be standard, cotan, delaunay, mean-value or uniform");
  }
  EXPECT_EQ(listed_choices({"a"}), "a");
  EXPECT_EQ(listed_choices({"a", "b"}), "a or b");
}

TEST(Names, WhatIsCountedIsSingularOnlyOnce) {
  EXPECT_EQ(counted(0, "face"), "0 faces");
  EXPECT_EQ(counted(1, "face"), "1 face");
  EXPECT_EQ(counted(2, "face"), "2 faces");
}

}  // namespace
}  // namespace orbitutte::names_test
