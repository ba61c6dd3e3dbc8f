// SPDX-License-Identifier: MIT
// What the page's script draws, as JSON; viewer/src/scene_data.js reads it.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/page/page.h"
#include "orbitutte/verify/distortion.h"

namespace orbitutte {

/// - `faces`: how many the cut mesh has; `shown_faces`, `copy_faces`: how many the source, and every copy
///   of the tile are drawn with;
/// - `vertices`: how many are drawn, and of these, base64 of little-endian numbers: `source` (uint16 x 3
/// within
///   the box `source_box`: low corner, edge length), `image` (float32 x 3), `normal` (int8 x 3, of the
///   source, times 127), `source_vertex` (uint32), `area` and `angle` (uint16 within `area_range`,
///   `angle_range`): log2 of the area ratio, and log2 of the ratio of singular values, averages over the
///   faces around; `colour` (uint8 x 3, sRGB), where the mesh has colours;
/// - `values`, where the colours stand for values: their `name`, `numbers` (base64 of float32), and `labels`,
///   pairs of key and name, if they are such;
/// - `fine` and `coarse`: `indices` and `outline`, base64 of uint32;
/// - `copies`: `transform` (row by row) and `colour` (sRGB) of the |G| copies, the tile itself first;
/// - `cones`: `vertex`, `order`, `colour` and `drawn`, the drawn vertices that are its copies;
/// - `scales`: for `area` and `angle` the `colours` from low to high, the values `low` and `high` (log2 of
/// the
///   area ratio; the ratio of singular values), `ticks` (`at`: 0 .. 1 along the scale, `text`) and `title`;
///   for `vertex` the same of the values, unless they are labels;
/// - `tile`, `ink`: the colours of the tile itself and of lines.
///
/// Holds no `<`, so that it can stand within a script element. Throws as weld_copies does where the seams
/// generate no group of the right order; then `copies` would mean nothing.
///
/// faces: as measure_triangles has them.
std::string page_scene(const PageSubject& subject, const std::vector<FaceDistortion>& faces,
                       const PageOptions& options = {});

}  // namespace orbitutte
