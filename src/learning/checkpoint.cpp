// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/checkpoint.hpp"

#include <stdexcept>

#include "learning/weights.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/output_files.hpp"

namespace rhizodont {

void require_training_folder(const std::filesystem::path& folder, bool resume) {
  if (folder.empty()) return;
  for (const char* name : {checkpoint_name, best_name}) {
    require_writable_place(folder / name);
    if (!resume && std::filesystem::exists(folder / name))
      throw UsageError("The folder " + folder.string() +
                       " holds the weights of an earlier run, which would be lost: go on with it (--resume) or name "
                       "another folder.");
  }
}

TensorFile weights_of_run(const std::filesystem::path& folder, TensorType type,
                          const std::map<std::string, std::string>& notes) {
  TensorFile file;
  if (std::filesystem::exists(folder / best_name)) {
    file = read_safetensors(folder / best_name);
  } else if (std::filesystem::exists(folder / checkpoint_name)) {
    const TensorFile checkpoint = read_safetensors(folder / checkpoint_name);
    const std::string prefix = "average.";
    for (const auto& [name, tensor] : checkpoint.tensors) {
      if (name.starts_with(prefix))
        file.tensors[name.substr(prefix.size())] = store_floats(load_floats(tensor), tensor.shape, type);
    }
    file.metadata = checkpoint.metadata;
  } else {
    throw InputError("The folder " + folder.string() + " has no weights to export.");
  }
  for (const auto& [key, text] : notes) file.metadata[key] = text;
  return file;
}

void store_progress(const std::vector<TrainedTensor>& tensors, const CheckpointProgress& progress, TensorFile& file) {
  for (const TrainedTensor& tensor : tensors) {
    file.tensors["value." + tensor.name] = store_tensor(tensor.value, TensorType::float32);
    file.tensors["mean." + tensor.name] = store_tensor(tensor.mean, TensorType::float32);
    file.tensors["square." + tensor.name] = store_tensor(tensor.square, TensorType::float32);
    file.tensors["average." + tensor.name] = store_tensor(tensor.average, TensorType::float32);
  }
  file.metadata["training.samples"] = std::to_string(progress.samples);
  file.metadata["training.steps"] = std::to_string(progress.steps);
  file.metadata["training.best"] = std::to_string(progress.best);
}

CheckpointProgress load_progress(const TensorFile& file, const std::map<std::string, std::string>& wanted,
                                 const std::filesystem::path& folder, std::vector<TrainedTensor>& tensors) {
  for (const auto& [key, value] : wanted) {
    const auto found = file.metadata.find(key);
    if (found == file.metadata.end() || found->second != value)
      throw InputError("The checkpoint in " + folder.string() + " was made with another " + key + ".");
  }
  for (TrainedTensor& tensor : tensors) {
    load_tensor(file, "value." + tensor.name, tensor.value);
    load_tensor(file, "mean." + tensor.name, tensor.mean);
    load_tensor(file, "square." + tensor.name, tensor.square);
    load_tensor(file, "average." + tensor.name, tensor.average);
  }
  try {
    return {std::stoull(file.metadata.at("training.samples")), std::stoull(file.metadata.at("training.steps")),
            std::stod(file.metadata.at("training.best"))};
  } catch (const std::logic_error&) {
    throw InputError("The checkpoint in " + folder.string() + " does not say how far it came.");
  }
}

}  // namespace rhizodont
