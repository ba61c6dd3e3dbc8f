// SPDX-License-Identifier: MIT
#include "orbitutte/report/choices.h"

#include <nlohmann/json.hpp>

namespace orbitutte {
namespace {

using Json = nlohmann::ordered_json;

Json summary_to_json(const ScaleSummary& summary) {
  return {{"sigma", summary.sigma},
          {"within_4", summary.within_4},
          {"below_64", summary.below_64},
          {"symmetric_dirichlet", summary.symmetric_dirichlet},
          {"range", summary.range}};
}

Json choice_to_json(const Choice& choice) {
  Json json = {{"orbifold", choice.target.signature}, {"cones", choice.cones}};
  if (choice.predicted) json["predicted"] = summary_to_json(*choice.predicted);
  if (choice.solved) {
    json["solved"] = Json::parse(distortion_json(*choice.solved));
    json["bijective"] = choice.is_certified;
  }
  if (!choice.refusal.empty()) json["refusal"] = choice.refusal;
  return json;
}

Json table_to_json(const std::vector<Choice>& choices, Objective objective) {
  Json rows = Json::array();
  for (const Choice& choice : choices) rows.push_back(choice_to_json(choice));
  return {{"objective", name_of(objective)}, {"choices", rows}};
}

std::string choice_text(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string choices_json(const std::vector<Choice>& choices, Objective objective) {
  return choice_text(table_to_json(choices, objective));
}

std::string report_json(const BestEmbedding& embedded, const RunRecord& run) {
  std::string plain = report_json(embedded.result, run);
  if (embedded.choices.empty()) return plain;
  Json json = Json::parse(plain);
  json["choice"] = table_to_json(embedded.choices, embedded.objective);
  json["choice"]["taken"] = embedded.taken;
  return choice_text(json);
}

}  // namespace orbitutte
