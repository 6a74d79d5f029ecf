// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "families/crown_crop.hpp"
#include "families/tooth_family.hpp"
#include "teeth/frame.hpp"
#include "training/completion_training_sample.hpp"
#include "training/sample_numbers.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rhizodont {

/// How training samples are made; the defaults are what the shipped weights were trained on.
struct CompletionSampleOptions {
  std::size_t input_points = 1024;        ///< points on the cropped crown, >= 1
  std::size_t target_points = 4096;       ///< points on the whole tooth, >= 1
  int type = -1;                          ///< tooth type 0..15, or -1: drawn anew for each sample
  double paper_crop_share = 0.15;         ///< share of crops at 1/2 .. 1/8 of the tooth's length, 0..1; the rest is cut
                                          ///< near the cemento-enamel junction as scans are
  double scanner_noise_mm = 0.02;         ///< standard deviation of the noise on the input points, >= 0
  double gap_probability = 0.3;           ///< share of crowns with missing interproximal surface, 0..1
  double skirt_probability = 0.2;         ///< share of crowns with remains of the gum along the cut, 0..1
  double skirt_mm = 0.9;                  ///< their largest width, >= 0
  double lost_turn_share = 0.05;          ///< share of crowns that are turned anyhow about the growth axis, 0..1
  double rotation_jitter_radians = 0.15;  ///< half width of the error of the rotation about the growth axis, >= 0;
                                          ///< beside crowns that are turned anyhow
  double form_axis_error_degrees = 4.0;   ///< standard deviation of the error of `form_axis` along x and y, >= 0, as
                                          ///< bench_families finds it; three times as much where the turn is lost,
                                          ///< and none is known of half of those
  double arch_axis_share = 0.25;          ///< share of crowns that stand as in an arch (axis_in_arch), 0..1
  double arch_axis_error_degrees = 6.0;   ///< standard deviation of how the arch's occlusal direction leans against the
                                          ///< crown's form along x and y there, >= 0
};

/// A training pair and what is known of its tooth beside it. All coordinates are canonical: growth axis +z (root to
/// crown), left side, origin at the crown's area-weighted centroid, unit 12 mm.
struct CompletionSample {
  /// What the network is trained on: points in random order; root is what lies outside the crop, of the corresponding
  /// points what is cementum. These are the generated tooth's vertices, if it was grown from its type's own template,
  /// else there are none. The axis of the form is the growth axis with the error of laying the type's mean crown on the
  /// crop.
  CompletionTrainingSample pair;
  std::vector<std::uint8_t> target_cement;  ///< per target point: 1 on cementum (below the junction), 0 on enamel
  CanonicalFrame frame;                     ///< from the generated tooth's millimetres to the canonical pose
  double root_length_mm = 0;   ///< lowest border point of the crop to the furthest apex along z, millimetres
  double crown_height_mm = 0;  ///< extent of the crop along z, millimetres
  std::vector<Point> apices;   ///< root tips in canonical coordinates, 1 to 3
  std::vector<Eigen::Vector3d> root_axes;  ///< unit, from each tip to where its root branches off, canonical
  Eigen::Vector3d growth_axis{0, 0, 1};    ///< the tooth's own, unit, canonical; differs from z by the tilt of the cut
  JunctionHeight junction;                 ///< cemento-enamel junction in the generated tooth's millimetres
  GumLine gum_line;                        ///< where the crown was cut, in the generated tooth's millimetres
  double furcation_z = 0;                  ///< height of the highest branching there; 0 for a single root
};

/// Makes training sample number `seed`: a random tooth of a random type, cropped and disturbed like a scan.
/// The frame comes from the cropped crown alone, as at inference; its rotation about z is the generator's own plus a
/// jitter that stands for the error of registration, or any rotation where the registration is lost. Depends on the
/// seed and options alone, so that any thread may make any sample; seeds below `first_validation_sample` are for
/// training, the others for validation. Throws NoResultError if no sound tooth came out of 20 draws (not seen in
/// practice), UsageError for bad options.
CompletionSample make_completion_sample(const ToothFamilies& families, std::uint64_t seed,
                                        const CompletionSampleOptions& options = {});

}  // namespace rhizodont
