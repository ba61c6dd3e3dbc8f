// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/embedding.h"

#include <Eigen/LU>

namespace orbitutte {

std::string name(SeamKind kind) {
  switch (kind) {
    case SeamKind::rotation:
      return "rotation";
    case SeamKind::reflection:
      return "reflection";
    case SeamKind::rotoreflection:
      return "rotoreflection";
  }
  return {};
}

SeamKind Seam::kind() const {
  if (left == right) return SeamKind::reflection;
  return transform.determinant() > 0 ? SeamKind::rotation : SeamKind::rotoreflection;
}

std::string name(ConeKind kind) {
  switch (kind) {
    case ConeKind::rotation:
      return "rotation";
    case ConeKind::corner:
      return "corner";
    case ConeKind::fixed:
      return "fixed";
  }
  return {};
}

}  // namespace orbitutte
