// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/arch_model.hpp"

#include "common/temporary_folder.hpp"
#include "networks/safetensors.hpp"
#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace rhizodont {
using test::TemporaryFolder;

namespace {

const std::filesystem::path shipped_file = std::filesystem::path(RHIZODONT_SOURCE_DIR) / "models" / "arch.safetensors";

TEST(ArchModel, ShippedOneHasAll32TeethAndIsSymmetric) {
  const ArchModel model = load_arch_model(shipped_file);
  ASSERT_EQ(model.teeth.size(), 32U);
  for (const auto& [left, tooth] : model.teeth) {
    if (left / 10 != 2 && left / 10 != 3) continue;
    const ArchTooth& right = model.teeth.at(left / 10 == 2 ? left - 10 : left + 10);
    const Eigen::Vector3d mirror(-1, 1, 1);
    EXPECT_LT((mirror.cwiseProduct(tooth.place) - right.place).norm(), 1e-5) << left;
    EXPECT_LT((mirror.cwiseProduct(tooth.directions.occlusal) - right.directions.occlusal).norm(), 1e-5) << left;
    EXPECT_LT((mirror.cwiseProduct(tooth.directions.buccal) - right.directions.buccal).norm(), 1e-5) << left;
    EXPECT_NEAR(tooth.directions.occlusal.dot(tooth.directions.buccal), 0, 1e-5) << left;
  }
}

TEST(ArchModel, TeethStandAsInAMouth) {
  const ArchModel model = load_arch_model(shipped_file);
  for (const auto& [fdi, tooth] : model.teeth) {
    const bool upper = fdi / 10 <= 2, left = fdi / 10 == 2 || fdi / 10 == 3;
    EXPECT_GT((upper ? -1 : 1) * tooth.directions.occlusal.y(), 0.7) << fdi;  // crowns face the other jaw
    EXPECT_GT((left ? 1 : -1) * tooth.place.x(), 0) << fdi;
    // Cheeks and lips are outside of the arch.
    const Eigen::Vector3d outwards = tooth.place - Point(0, tooth.place.y(), -15);
    EXPECT_GT(tooth.directions.buccal.dot(outwards.normalized()), 0.5) << fdi;
  }
  // Incisors lean to the front, lower second molars inwards and forwards (Tong et al. 2012).
  EXPECT_GT(model.teeth.at(21).directions.occlusal.z(), 0.4);
  EXPECT_GT(model.teeth.at(31).directions.occlusal.z(), 0.3);
  EXPECT_LT(model.teeth.at(37).directions.occlusal.x(), -0.1);
  EXPECT_GT(model.teeth.at(37).directions.occlusal.z(), 0.1);
}

TEST(ArchModel, ThirdMolarsStandBehindSecondOnes) {
  const ArchModel model = load_arch_model(shipped_file);
  for (const int quadrant : {1, 2, 3, 4}) {
    const Point &second = model.teeth.at(10 * quadrant + 7).place, &third = model.teeth.at(10 * quadrant + 8).place;
    EXPECT_LT(third.z(), second.z() - 6) << quadrant;
    EXPECT_NEAR((third - second).norm(), 9.5, 2) << quadrant;
  }
  ArchModel none;
  EXPECT_THROW(add_third_molars(none), UsageError);
}

TEST(ArchModel, FilesGoOutAndIn) {
  const TemporaryFolder folder;
  const ArchModel model = load_arch_model(shipped_file);
  save_arch_model(model, folder.path() / "arch.safetensors");
  const ArchModel again = load_arch_model(folder.path() / "arch.safetensors");
  for (const auto& [fdi, tooth] : model.teeth) {
    EXPECT_EQ(tooth.place, again.teeth.at(fdi).place) << fdi;
    EXPECT_EQ(tooth.turn_covariance, again.teeth.at(fdi).turn_covariance) << fdi;
  }
}

TEST(ArchModel, DamagedFilesAreRefused) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "arch.safetensors";
  EXPECT_THROW(load_arch_model(path), InputError);
  const TensorFile good = read_safetensors(shipped_file);
  const auto refused = [&](const TensorFile& file) {
    write_safetensors(path, file);
    EXPECT_THROW(load_arch_model(path), InputError);
  };
  for (const auto& [name, tensor] : good.tensors) {
    TensorFile without = good;
    without.tensors.erase(name);
    refused(without);
    TensorFile shorter = good;
    shorter.tensors[name] = store_floats(std::vector<float>{1, 2, 3}, {1, 3});
    refused(shorter);
  }
  TensorFile bent = good;
  std::vector<float> longer = load_floats(good.tensors.at("occlusal"));
  for (float& x : longer) x *= 2;
  bent.tensors["occlusal"] = store_floats(longer, {28, 3});
  refused(bent);
  std::vector<float> places = load_floats(good.tensors.at("places"));
  places[5] = std::numeric_limits<float>::quiet_NaN();
  bent = good;
  bent.tensors["places"] = store_floats(places, {28, 3});
  refused(bent);
}

}  // namespace
}  // namespace rhizodont
