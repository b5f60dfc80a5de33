// SPDX-License-Identifier: MIT
// Names that a program gives its objects for people to read (GL_KHR_debug). A label goes with its object: a new one of
// the same kind and name has none. Application's thread; whoever shares the objects guards it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "common/glapi/gl_types.h"

namespace wall::client {

class ObjectLabels {
public:
    static constexpr std::size_t kMostText = 256;  ///< GL_MAX_LABEL_LENGTH, with the zero behind it

    /// `object`: that the kind's name stands for. An empty text takes the label away.
    void set(GLenum kind, GLuint name, const std::shared_ptr<void>& object, std::string text) {
        if (text.empty()) labels_.erase({kind, name});
        else labels_[{kind, name}] = {object, std::move(text)};
    }
    std::string get(GLenum kind, GLuint name, const std::shared_ptr<void>& object) const {
        const auto found = labels_.find({kind, name});
        return found != labels_.end() && found->second.object.lock() == object ? found->second.text : std::string();
    }

private:
    struct Label {
        std::weak_ptr<void> object;
        std::string text;
    };
    std::map<std::pair<GLenum, GLuint>, Label> labels_;
};

}  // namespace wall::client
