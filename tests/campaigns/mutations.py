# SPDX-License-Identifier: GPL-3.0-or-later
"""Small changes of C++ text, one at a time: operators and constants of code, never of comments, strings,
includes, messages or checks at compile time."""
import re
from typing import NamedTuple

SWAPS = [(" + ", " - "), (" * ", " / "), (" += ", " -= "), (" *= ", " /= "), (" == ", " != "), (" && ", " || "),
         ("++", "--"), ("std::min(", "std::max("), ("minCoeff", "maxCoeff"), ("cwiseMin", "cwiseMax"),
         ("min_element", "max_element"), (" < ", " >= "), (" > ", " <= ")]
# Of a loop its end moves by one; elsewhere most comparisons are of lengths and forces, which meet their
# limit itself by chance only, so that a change there is the other answer everywhere.
IN_LOOPS = {" < ": " <=", " <= ": " <", " > ": " >=", " >= ": " >"}
LOOP = re.compile(r"\bfor \([^;()]*(?:\([^()]*\)[^;()]*)*;[^;]*$")
COMPARISON = re.compile(r" (?:[<>]=?|[!=]=) ")
NUMBER = re.compile(r"(?<![\w.'])(\d+\.\d*(?:e[+-]?\d+)?|\d+(?:e[+-]?\d+)?)(?![\w.'])")
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\'|'
                             r"^[ ]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)
# Calls whose arguments are messages, checked by the compiler, or of no effect on what is computed.
UNTOUCHED = re.compile(r"\b(?:bad_input|not_a_state|Error|static_assert|to_string|reserve)\(")
# Kinds of code whose numbers are sizes of types: the compiler's matter.
SIZES = re.compile(r"<[^<>;()]*>|\b(?:double|int|float|Real|char|V|Vec3|T) \w+\[[^\]]*\]|\balignas\([^)]*\)")

# What no test can notice: (file, line, what is changed in it, reason). Few, and looked at one by one.
EQUIVALENT = [
    (r".*", r"_per_(piece|thread|task) = |constexpr std::size_t piece = ", r"\d+",
     "how work is split: results do not depend on it"),
    (r".*", r"1e-9\b", r"1e-9", "a tolerance of roundings, a fifth larger"),
    (r".*metrics/(rest_body|frame|limits|sections|summary|surface_distortion|report/playback|report/report)\.h",
     r"^  [\w:<>]+ \w+ = 0(, \w+ = [01])*;|double fraction = 1\)", r"[01]", "a value that is always given"),
    (r".*report/playback\.cpp", r"place\(stand_in.size\(\), -1\)", r"1", "every place that is read was set"),
    (r".*sections\.cpp", r"for \(std::size_t i = begin", r"\+\+", "pieces of one"),
    (r".*surface_distortion\.cpp", r"^Vec3 area_vector", r"0", "a triangle's area is that from any of its corners"),
    (r".*comparison_page\.cpp", r"i < worst.metrics", r"0", "the first metric is the time, which has no worst frame"),
    (r".*slices\.cpp", r"double last = -2;", r"2", "what comes before the first is none of its neighbors"),
    (r".*stepping/simulation\.cpp", r"world_ledger_\.add_step\(sums\.world_power, 0\)", r"0",
     "only its work is asked for"),
    (r".*solid\.cpp", r"volume_\.assign\(n, 0\)", r"0", "each is found before it is asked for"),
    (r".*stepping/simulation\.h", r"double held_at_start_ = 0;", r"0", "the first step finds it"),
    (r".*bone_slots\.cpp", r"\[\]\(Real share\)", r" ==", "shares of one that are kept give the same forces, later"),
    (r".*metrics/rest_body\.cpp", r"i < input\.bones\.size\(\)", r"0", "the first bone has no parent, so no joint"),
    (r".*summary\.cpp", r"first < bones\.size\(\);\) \{", r" <", "nothing is held beyond the last frame"),
    (r".*report/page\.cpp", r"dump\(-1", r"1", "any negative number asks for one line"),
    (r".*instruction_set\.cpp", r"__builtin_cpu_supports", r" &&", "processors that have the one have the other"),
    (r".*(approach_bounds|offset_lists)\.cpp", r"while \(along\(0\)", r"[\d.]+", "when a table of cells counts as too large"),
    (r".*bone_slots\.cpp", r"if \(weight\[b\] > 0\)", r"0", "the mean of one is itself"),
    (r".*offset_lists\.cpp", r"part\.value\.resize\(wider", r"1", "room for one more"),
    (r".*verlet_lists\.cpp", r"pose\.size\(\) \+ 1, *$", r"1", "room for one frame more"),
    (r".*particle_values\.cpp", r"double near = 0, far = 0", r"0", "near is only subtracted from another near"),
]


class Mutant(NamedTuple):
    file: str  # below the project's folder
    begin: int
    old: str
    new: str
    line: int

    def applied_to(self, text):
        assert text[self.begin:self.begin + len(self.old)] == self.old, self
        return text[:self.begin] + self.new + text[self.begin + len(self.old):]

    def __str__(self):
        return f"{self.file}:{self.line}: {self.old.strip()} -> {self.new.strip()}"


def blank(match):
    """As long as before, so that places stay; the ends of a text are kept."""
    text = match.group()
    inside = "".join("\n" if letter == "\n" else " " for letter in text[1:-1])
    return '"' + inside + '"' if text.endswith('"') else " " + inside + " " if len(text) > 1 else " "


def end_of_call(code, opening):
    depth = 0
    for place in range(opening, len(code)):
        depth += {"(": 1, ")": -1}.get(code[place], 0)
        if depth == 0:
            return place
    raise ValueError(f"parenthesis at {opening} is not closed")


def code_of(text):
    """The text with everything that is not to be changed as blanks, and of the same length."""
    code = COMMENT_OR_TEXT.sub(blank, text)
    while call := UNTOUCHED.search(code):
        end = end_of_call(code, call.end() - 1) + 1
        code = code[:call.start()] + re.sub(r"[^\n]", " ", code[call.start():end]) + code[end:]
    return code


def swaps(code):
    for one, other in SWAPS:
        for old, new in ((one, other), (other, one)):
            # An operator at the end of a line has no blank behind it.
            pattern = re.escape(old.rstrip()) + (r"(?=\s)" if old.endswith(" ") else "")
            for match in re.finditer(pattern, code):
                beside = code[:match.start()].rstrip()[-1:] + code[match.end():].lstrip()[:1]
                if '"' not in beside:  # texts are joined, not added
                    before = code[code.rfind("\n", 0, match.start()) + 1:match.start()]
                    in_loop = old in IN_LOOPS and LOOP.search(before)
                    yield match.start(), match.group(), IN_LOOPS[old] if in_loop else new.rstrip()


def another_number(old):
    if re.fullmatch(r"\d+", old):
        return str(int(old) + (int(old) // 5 if int(old) > 1000 else 1))
    return "1.0" if float(old) == 0 else f"{1.2 * float(old):.6g}"


def constants(code):
    for match in NUMBER.finditer(SIZES.sub(lambda sized: " " * len(sized.group()), code)):
        yield match.start(), match.group(), another_number(match.group())


def negations(code):
    for match in re.finditer(r"\b(?:if|while) \(", code):
        end = end_of_call(code, match.end() - 1)
        condition = code[match.end():end]
        if COMPARISON.search(condition) and not re.search(r"&&|\|\|", condition):
            continue  # its comparison is changed already
        if ";" not in condition and not re.match(r"(?:const )?[\w:<>*&]+ \w+ =|auto", condition):
            yield match.end(), condition, f"!({condition})"


def is_equivalent(file, line, old):
    return any(re.fullmatch(name, file) and re.search(words, line) and re.fullmatch(what, old)
               for name, words, what, _ in EQUIVALENT)


def mutants_of(file, text):
    """All of a file, in their order."""
    code, lines = code_of(text), text.splitlines()
    found = []
    for begin, old, new in [*swaps(code), *constants(code), *negations(code)]:
        if "\n" in old:
            continue
        line = code.count("\n", 0, begin) + 1
        # What a condition says may hold text that was blanked.
        old = text[begin:begin + len(old)]
        new = f"!({old})" if new.startswith("!(") else new
        if not is_equivalent(file, lines[line - 1], old):
            found.append(Mutant(file, begin, old, new, line))
    return sorted(set(found))


def sample(mutants, count, chance):
    """Every n-th of the list from a random start: each file has its share."""
    if count >= len(mutants):
        return list(mutants)
    width = len(mutants) / count
    start = chance.uniform(0, width)
    return [mutants[int(start + k * width)] for k in range(count)]
