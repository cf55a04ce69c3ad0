# SPDX-License-Identifier: BSD-3-Clause
"""Checks that a source includes the library headers whose names it uses, directly or through headers of this tree.

Builds with precompiled headers and joint files (groups.py) include all library headers, so they do not detect a missing include.
Headers of this tree are never precompiled, so the compiler detects missing includes of these headers.
"""
import functools
import pathlib
import re

# Names that each header provides, by the standard or in every implementation.
_CONTAINERS = "array deque list map set span string string_view tuple unordered_map unordered_set vector".split()
_COMMON = [*_CONTAINERS, "algorithm", "functional", "memory", "utility", "iterator", "optional"]
_OF_COMMON = """size_t ptrdiff_t move swap pair make_pair exchange initializer_list begin end size next prev distance
    index_sequence make_index_sequence""".split()
_STREAMS = "ostream istream fstream sstream iostream".split()

_HEADERS = {
    "algorithm": """partition_point adjacent_find all_of any_of binary_search clamp copy_if count count_if equal_range fill_n find find_if
        find_if_not includes is_sorted iter_swap lower_bound max_element min_element minmax minmax_element mismatch next_permutation none_of nth_element replace replace_if
        reverse reverse_copy rotate search set_difference set_union sort stable_partition stable_sort transform unique upper_bound ranges""",
    "atomic": "atomic",
    "bit": "bit_cast bit_ceil countr_zero endian popcount",
    "cctype": "isalnum isalpha isdigit islower tolower toupper",
    "charconv": "chars_format from_chars to_chars",
    "chrono": "chrono milli",
    "cmath": """acos asin atan atan2 atanh cbrt ceil comp_ellint_1 copysign cos ellint_1 erfc exp exp2 expm1 floor fmax fmin fmod hypot
        isfinite isinf isnan ldexp lgamma llround log log10 log1p log2 lround nan nanf nextafter pow remainder round signbit sin sqrt tan
        tanh""",
    "complex": "complex norm polar",
    "concepts": "same_as unsigned_integral",
    "csignal": "signal",
    "cstdint": "int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t uintmax_t",
    "cstdio": "fflush fgets fprintf fputs puts fread freopen fwrite printf rename setvbuf snprintf",
    "cstdlib": "_Exit abort atof atoi exit free getenv llabs malloc realloc strtod strtol strtoull system",
    "cstring": "memcmp memcpy strcmp strerror strlen",
    "ctime": "clock clock_t strftime time time_t tm",
    "deque": "deque",
    "exception": "current_exception exception_ptr rethrow_exception",
    "filesystem": "filesystem",
    "fstream": "ifstream ofstream",
    "functional": "bit_xor function identity",
    "iostream": "cerr cin cout",
    "limits": "numeric_limits",
    "list": "list",
    "map": "map multimap",
    "memory": "construct_at destroy_at make_shared make_unique shared_ptr unique_ptr",
    "mutex": "lock_guard mutex",
    "new": "bad_alloc nothrow_t",
    "numbers": "numbers",
    "numeric": "accumulate inner_product iota midpoint",
    "optional": "nullopt optional",
    "random": "chi_squared_distribution exponential_distribution mt19937 mt19937_64 normal_distribution uniform_real_distribution",
    "regex": "regex regex_replace regex_search smatch sregex_iterator",
    "set": "multiset set",
    "span": "as_bytes as_writable_bytes span",
    "sstream": "istringstream ostringstream stringstream",
    "stdexcept": "invalid_argument logic_error out_of_range runtime_error",
    "thread": "this_thread thread",
    "type_traits": "conditional_t decay_t integral_constant is_arithmetic_v is_const_v is_assignable_v is_constructible_v is_convertible_v is_default_constructible_v is_enum_v is_floating_point_v is_integral_v is_invocable_v is_same_v remove_const_t remove_cv_t remove_cvref_t underlying_type_t",
    "unordered_map": "unordered_map",
    "unordered_set": "unordered_set",
    "variant": "get_if holds_alternative variant variant_alternative_t variant_size_v visit",
    "utility": "as_const declval in_place",
    "vector": "vector",
}
_ANY_OF = {
    "abs": ["cmath", "cstdlib"],
    "array": ["array"],
    "back_inserter": ["iterator", *_CONTAINERS], "istream_iterator": ["iterator"], "istreambuf_iterator": ["iterator", *_STREAMS],
    "byte": ["cstddef", "span"], "to_integer": ["cstddef"],
    "for_each": ["algorithm"], "copy": ["algorithm"], "copy_n": ["algorithm"], "equal": ["algorithm"], "fill": ["algorithm"],
    "max": ["algorithm"], "min": ["algorithm"],
    "erase": ["string", "vector", "deque", "list"], "erase_if": ["string", "vector", "deque", "list", "map", "set"],
    "errc": ["charconv", "system_error"], "error_code": ["filesystem", "system_error"], "generic_category": ["system_error"],
    "make_error_code": ["system_error"], "system_error": ["system_error", "filesystem"],
    "exception": ["exception", "stdexcept", "filesystem", "new", "functional", "memory"],
    "getline": ["string"], "ssize": ["iterator", "span", "string", "vector"], "showpoint": ["ios", "iostream", "sstream"], **dict.fromkeys("ios ios_base istream ostream streamoff streamsize ws".split(), _STREAMS),
    "stod": ["string"], "stoll": ["string"], "string": ["string"], "to_string": ["string"],
    "string_view": ["string_view", "string"],
    "less": ["functional", "map", "set"],
    "get": ["tuple", "utility", "array", "variant"], "tie": ["tuple"], "tuple": ["tuple"], "tuple_size_v": ["tuple", "array"],
}
_STANDARD = {name: [header] for header, names in _HEADERS.items() for name in names.split()}
_STANDARD |= {name: [*_COMMON, "cstddef", "initializer_list"] for name in _OF_COMMON} | _ANY_OF

_DENSE = ["Eigen/Dense"]
_EIGEN_GEOMETRY = ["Eigen/Geometry", *_DENSE]
_LIBRARIES = [(re.compile(pattern), headers) for pattern, headers in [
    (r"\bEigen::(?:Quaternion|Isometry|AngleAxis|Translation|AlignedBox|Affine)\w*|\.cross\(|\.unitOrthogonal\(", _EIGEN_GEOMETRY),
    (r"\bEigen::LLT\b|\bEigen::LDLT\b|\.llt\(|\.ldlt\(", ["Eigen/Cholesky", *_DENSE]),
    (r"\bEigen::\w*EigenSolver\b", ["Eigen/Eigenvalues", *_DENSE]),
    (r"\bEigen::JacobiSVD\b", ["Eigen/SVD", *_DENSE]),
    (r"\.(?:determinant|partialPivLu|fullPivLu)\(", ["Eigen/LU", "Eigen/Geometry", *_DENSE]),
    (r"\bEigen::Sparse\w+", ["Eigen/SparseCore", "Eigen/SparseCholesky", "Eigen/Sparse"]),
    (r"\bEigen::", ["Eigen/Core", "Eigen/LU", "Eigen/Cholesky", "Eigen/Eigenvalues", "Eigen/SVD", "Eigen/QR", "Eigen/SparseCore",
                    "Eigen/SparseCholesky", *_EIGEN_GEOMETRY]),
    (r"\b(?:EXPECT|ASSERT)_THAT\(|\btesting::(?:ElementsAre|HasSubstr|Each|Pointwise)\b", ["gmock/gmock.h"]),
    (r"\bTEST(?:_[FP])?\(|\b(?:EXPECT|ASSERT)_[A-Z]+\(", ["gtest/gtest.h", "gmock/gmock.h"]),
]]
_COMMENT_OR_TEXT = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|//[^\n]*|/\*.*?\*/', re.S)
_STANDARD_NAME = re.compile(r"\bstd::(\w+)")
_INCLUDE = re.compile(r'^#\s*include ([<"])([^>"]+)[>"]', re.M)


class Tree:
    """Tree contains the sources below a root, and the headers that each source includes."""

    def __init__(self, root: pathlib.Path):
        self._root = root
        self._reaches = functools.cache(self._reached)

    def _reached(self, file: pathlib.Path) -> frozenset[pathlib.Path | str]:
        """Returns the headers that the file includes directly: headers of this tree by path, headers of libraries by name."""
        out = set()
        for bracket, name in _INCLUDE.findall(file.read_text()):
            places = [folder / name for folder in (file.parent, self._root, self._root / "estimator/include", self._root / "tests")]
            own = next((place.resolve() for place in places if place.is_file()), None)
            out.add(own or name)
        return frozenset(out)

    def in_sight(self, file: pathlib.Path) -> set[str]:
        """Returns the names of the library headers that the file includes, directly or through headers of this tree."""
        seen: set[pathlib.Path | str] = set()
        waiting: list[pathlib.Path | str] = [file]
        while waiting:
            now = waiting.pop()
            if now not in seen:
                seen.add(now)
                waiting += self._reaches(now) if isinstance(now, pathlib.Path) else ()
        return {name for name in seen if isinstance(name, str)}

    def complaints(self, file: pathlib.Path) -> list[str]:
        code = _COMMENT_OR_TEXT.sub(lambda found: "\n" * found[0].count("\n"), file.read_text())
        in_sight = self.in_sight(file)
        place = file.relative_to(self._root)
        out = []
        for name in sorted(set(_STANDARD_NAME.findall(code))):
            if name not in _STANDARD:
                out.append(f"{place}: std::{name} is unknown; add this name and its header to tools/linting/includes.py")
            elif in_sight.isdisjoint(_STANDARD[name]):
                out.append(f"{place}: uses std::{name} without <{_STANDARD[name][0]}>")
        for pattern, headers in _LIBRARIES:
            if (found := pattern.search(code)) and in_sight.isdisjoint(headers):
                out.append(f"{place}: uses {found[0]} without <{headers[0]}>")
        return out


def complaints(root: pathlib.Path, names: list[str]) -> list[str]:
    tree = Tree(root.resolve())
    return [text for name in names for text in tree.complaints(root.resolve() / name)]
