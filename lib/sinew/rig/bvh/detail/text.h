// SPDX-License-Identifier: GPL-3.0-or-later
// The words and numbers of a BVH file, each with its place.
//
//     BvhText text(path, contents);
//     text.expect("HIERARCHY", "begin the file with HIERARCHY");
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <sinew/core/error.h>

namespace sinew {

/// Whether two words are equal but for case.
bool same_word(std::string_view a, std::string_view b);

/// Reads a text word by word. Words end at spaces and line ends (LF, CRLF or CR); '{', '}' and ':'
/// are words of their own. Errors name the last word.
class BvhText {
 public:
  /// `text` must outlive this; `file` is its name in errors.
  BvhText(std::string file, std::string_view text);

  bool at_end();                     ///< only space is left
  std::string_view peek();           ///< the next word, "" at the end
  std::string_view next();           ///< takes it
  bool take(std::string_view word);  ///< takes the next word if it is this one, in any case
  void expect(std::string_view word, const char* cure);  ///< takes it, or throws bad input

  /// The rest of this line up to a brace, without the spaces around it: a joint's name.
  std::string_view name();

  double number(const char* what);         ///< throws bad input unless finite, and at most 1e9
  std::int64_t integer(const char* what);  ///< throws bad input unless one

  std::string_view rest() const { return text_.substr(at_); }  ///< what has not been read yet
  std::size_t position() const { return start_; }              ///< position of the last word
  Place place() const { return place(start_); }
  Place place(std::size_t position) const;
  Place place_of(std::string_view part) const {  ///< place of a part of rest()
    return place(static_cast<std::size_t>(part.data() - text_.data()));
  }
  Error wrong(const std::string& what, const std::string& cure) const;  ///< at place()

 private:
  void skip_space();
  void check_name(std::string_view name) const;

  std::string file_;
  std::string_view text_;
  std::size_t at_ = 0, start_ = 0;
};

}  // namespace sinew
