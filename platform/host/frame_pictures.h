// SPDX-License-Identifier: Apache-2.0
// Where --frames puts the annotated picture of each frame: one file a frame, and never over the user's own pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "platform/host/dataset.h"

namespace touchline::host {

/// The folder below `frames_out` for a set's pictures: its name, as far as a folder can have it.
std::filesystem::path picture_folder(const std::string& frames_out, const std::string& set_name);
/// A name for each frame's picture, all different: the image's own, with a number where it is taken.
std::vector<std::string> picture_names(const std::vector<DataFrame>& frames);
/// Throws HostError when a picture would be written over an image of one of the sets, or into a folder with such
/// images. An empty `frames_out` writes nothing.
void refuse_to_overwrite(const std::vector<DataSet>& sets, const std::string& frames_out);

}  // namespace touchline::host
