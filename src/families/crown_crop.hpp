// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/random_stream.hpp"
#include "families/tooth_family.hpp"
#include "teeth/frame.hpp"

#include <array>
#include <optional>

namespace rhizodont {

/// Where a crown ends: a height over the tooth's frame that depends on the direction around the axis.
struct GumLine {
  double junction_share = 1;                        ///< how much of the junction's own curve it follows
  double offset_mm = 0;                             ///< above (+, towards the cusps) or below (-) that curve
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< tilt, height per millimetre along x and y
  std::array<double, 5> wave_mm{};                  ///< amplitudes of 1..5 waves around the tooth
  std::array<double, 5> wave_phase{};               ///< radians
  std::array<double, 2> gap_mm{};                   ///< missing surface at the contacts (towards -x and +x)
  std::array<double, 2> gap_width{0.3, 0.3};        ///< half width of these notches, radians

  double side_mm = 0;                     ///< how much higher it stands on one side
  double side_angle = 0, side_width = 1;  ///< that side's direction and half width, radians

  /// Height of the line for a position around the axis, millimetres in the tooth's frame.
  double height(const JunctionHeight& junction, double x, double y) const;
};

/// Slope (GumLine::slope) of a cut across the tooth's own long axis: that of crown and root, the growth axis of the
/// paper, where the frame's z is across the cemento-enamel junction. Zero where that is over 20 degrees: very short
/// roots leave the crown's width as the longest extent.
Eigen::Vector2d slope_across_long_axis(const SyntheticTooth& tooth);

/// How scans end: near the junction, with waves, papillae, tilt and sides that stand higher, a third of them across the
/// tooth's long axis like crowns trimmed from whole teeth, the others along gum lines: one in twelve of these leans by
/// 15 to 35 degrees, half lack their surface below the contacts. The rest are cut across the long axis at 1/2 to 1/8 of
/// the tooth's length (paper, 3.3). `paper_share` is that rest, `gap_probability` the share with notches at contacts.
GumLine draw_gum_line(const SyntheticTooth& tooth, double paper_share, double gap_probability, RandomStream& random);

/// The part of the tooth above the gum line, cut through the triangles; the piece that holds the highest vertex.
/// Nothing if that piece is not a disc (one border loop, no handle).
std::optional<TriangleMesh> crop_crown(const SyntheticTooth& tooth, const GumLine& line);

/// Draws gum lines until one leaves a disc, raising it or starting anew. Throws NoResultError after 30 attempts.
struct CroppedCrown {
  TriangleMesh mesh;
  GumLine line;
};
CroppedCrown draw_cropped_crown(const SyntheticTooth& tooth, double paper_share, double gap_probability,
                                RandomStream& random);

/// A crown as a technician trims it: along the junction's own curve, a little above. Throws NoResultError if it does
/// not come off in one piece.
CroppedCrown trim_clean(const SyntheticTooth& tooth, RandomStream& random);

/// Adds what a careless cut leaves of the gum: one to three flaps along the border, up to `width_mm` wide, that turn
/// outwards or hang down. The crown's own triangles stay first and unchanged. @param crown a disc
void add_skirt_remains(TriangleMesh& crown, double width_mm, RandomStream& random);

/// Axis and centre from an open crown in the generator's own frame; about the axis that frame, turned by `turn`
/// radians.
CanonicalFrame frame_of_crop(const TriangleMesh& crown, double turn);
/// The same about another axis (unit, from root to crown).
CanonicalFrame frame_of_crop(const TriangleMesh& crown, const Eigen::Vector3d& axis, double turn);

}  // namespace rhizodont
