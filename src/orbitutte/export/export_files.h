// SPDX-License-Identifier: MIT
// The bytes of a model in each file format; see write_model. Private to export/.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/export/export.h"

namespace orbitutte {

std::string obj_text(const ExportedModel& model);
std::string glb_bytes(const ExportedModel& model);
std::string ply_bytes(const ExportedModel& model);
std::string vtp_text(const ExportedModel& model);

/// log2 A of every face (m); zero if the face was not measured.
std::vector<double> face_quality(const ExportedModel& model);

/// The mean quality of the faces around every input vertex (n).
std::vector<double> vertex_quality(const ExportedModel& model);

}  // namespace orbitutte
