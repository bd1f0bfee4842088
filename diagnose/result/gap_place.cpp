#include "diagnose/result/gap_place.h"

namespace glidelab::diagnose {

std::string_view to_text(Stage stage) {
  switch (stage) {
    case Stage::dynamics:
      return "dynamics";
    case Stage::optics:
      return "optics";
    case Stage::timing:
      return "timing";
    case Stage::sensor:
      return "sensor";
    case Stage::tracking:
      return "tracking";
    case Stage::analysis:
      return "analysis";
  }
  return {};
}

std::string_view to_text(GapVariable variable) {
  switch (variable) {
    case GapVariable::acceleration:
      return "a_m_s2";
    case GapVariable::clip:
      return "clip";
    case GapVariable::direction:
      return "direction";
    case GapVariable::set_up:
      return "group";
    case GapVariable::mass:
      return "mass_kg";
    case GapVariable::time:
      return "t_s";
    case GapVariable::column:
      return "u_px";
    case GapVariable::speed:
      return "v_m_s";
    case GapVariable::row:
      return "v_px";
    case GapVariable::position:
      return "x_m";
  }
  return {};
}

std::string_view to_text(GapKind kind) {
  switch (kind) {
    case GapKind::force:
      return "force";
    case GapKind::friction:
      return "friction";
    case GapKind::viscous_drag:
      return "viscous drag";
    case GapKind::acceleration:
      return "acceleration";
    case GapKind::displacement:
      return "displacement";
    case GapKind::lateness:
      return "delay";
    case GapKind::scale:
      return "scale";
    case GapKind::intercept:
      return "intercept";
    case GapKind::drag:
      return "drag";
    case GapKind::marker_width:
      return "marker's width";
    case GapKind::marker_shear:
      return "marker's shear";
    case GapKind::brightness:
      return "brightness";
    case GapKind::scene_place:
      return "the scene's place";
    case GapKind::block_steps:
      return "steps between blocks";
  }
  return {};
}

std::string_view to_text(Against against) {
  switch (against) {
    case Against::plumb:
      return "plumb";
    case Against::stated:
      return "stated";
    case Against::all_clips:
      return "all clips";
  }
  return {};
}

std::string_view to_text(GapDomainKind domain) {
  switch (domain) {
    case GapDomainKind::positions:
      return "positions";
    case GapDomainKind::phase_plane:
      return "phase_plane";
    case GapDomainKind::parameters:
      return "parameters";
    case GapDomainKind::images:
      return "picture";
  }
  return {};
}

}  // namespace glidelab::diagnose
