#pragma once

#include <signorini/validation/input_error.h>
#include <signorini/validation/sdf_reader.h>

#include <gtest/gtest.h>
#include <string>

namespace signorini::validation {

/// A world around some models.
inline std::string world(const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<sdf version=\"1.9\" xmlns:signorini=\"urn:signorini\">\n"
         "<world name=\"w\">\n" +
         content + "\n</world></sdf>";
}

/// A model of one link with a box, and something more in the link or the collision.
inline std::string box_model(const std::string& in_link, const std::string& in_collision = "",
                             const std::string& in_model = "") {
  return "<model name=\"brick\">" + in_model + "<link name=\"body\">" + in_link +
         "<collision name=\"c\"><geometry><box><size>1 2 3</size></box></geometry>" + in_collision +
         "</collision></link></model>";
}

/// A model of one link with one shape.
inline std::string model_of(const std::string& geometry, const std::string& in_model = "",
                            const std::string& in_link = "", const std::string& in_collision = "") {
  return "<model name=\"m\">" + in_model + "<link name=\"l\">" + in_link +
         "<collision name=\"c\"><geometry>" + geometry + "</geometry>" + in_collision +
         "</collision></link></model>";
}

inline Scene read(const std::string& content, const ReadOptions& options = {}) {
  return read_scene_text(world(content), "test.sdf", options);
}

/// The message of the refusal; empty if there is none.
inline std::string refusal(const std::string& text, const ReadOptions& options = {}) {
  try {
    (void)read_scene_text(text, "test.sdf", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline bool mentions(const Scene& scene, const std::string& words) {
  for (const std::string& notice : scene.notices) {
    if (notice.find(words) != std::string::npos) return true;
  }
  return false;
}

/// A URDF robot of one link.
inline std::string robot(const std::string& in_link) {
  return "<robot name=\"r\"><link name=\"base\"><inertial><mass value=\"2\"/>"
         "<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>" +
         in_link + "</link></robot>";
}

}  // namespace signorini::validation

#define EXPECT_NAMES(text, words) EXPECT_NE((text).find(words), std::string::npos) << (text)
