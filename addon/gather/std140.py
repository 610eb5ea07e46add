# SPDX-License-Identifier: GPL-3.0-or-later
"""Uniform blocks: named fields, declared once, as the numpy layout that the host fills and as the struct of GLSL.

Blocks follow std140, by which OpenGL and Vulkan lay them out. Metal lays structs out as C does; both agree because
every gap is filled by a field of its own, arrays have elements of whole 16 bytes, and nothing shares those of a vec3.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

# By name in a declaration: scalar, shape, alignment in bytes, name in GLSL. A bool is an int there, compared with 0:
# drivers disagree on bools in blocks.
TYPES: dict[str, tuple[type, tuple[int, ...], int, str]] = {
    "int": (np.int32, (), 4, "int"),
    "uint": (np.uint32, (), 4, "uint"),
    "bool": (np.int32, (), 4, "int"),
    "float": (np.float32, (), 4, "float"),
    "vec2": (np.float32, (2,), 8, "vec2"),
    "ivec2": (np.int32, (2,), 8, "ivec2"),
    "vec3": (np.float32, (3,), 16, "vec3"),
    "vec4": (np.float32, (4,), 16, "vec4"),
    "mat4": (np.float32, (4, 4), 16, "mat4"),  # [k] is column k in GLSL
}


@dataclass(frozen=True)
class Field:
    """A field of a block. type: a name of TYPES, or a Struct. meaning: with its unit. count: of an array's elements; 0
    where it is none. optional: zero where the host does not give it."""

    name: str
    type: str | Struct
    meaning: str
    count: int = 0
    optional: bool = False

    @property
    def element(self) -> np.dtype:
        """The layout of one element."""
        if isinstance(self.type, Struct):
            return self.type.dtype
        scalar, shape, *_ = TYPES[self.type]
        return np.dtype((scalar, shape))

    @property
    def alignment(self) -> int:
        return 16 if self.count or isinstance(self.type, Struct) else TYPES[self.type][2]

    @property
    def size(self) -> int:
        """Bytes that it keeps others from."""
        return 16 if self.type == "vec3" else self.element.itemsize * max(self.count, 1)

    @property
    def glsl(self) -> str:
        kind = self.type.name if isinstance(self.type, Struct) else TYPES[self.type][3]
        return f"{kind} {self.name}{f'[{self.count}]' if self.count else ''};"


@dataclass(frozen=True)
class Struct:
    """A struct of GLSL, or a whole block, with these fields in this order."""

    name: str
    fields: tuple[Field, ...]

    @cached_property
    def offsets(self) -> list[int]:
        """Bytes from the start to each field, then to the end, which is a multiple of 16. Raises ValueError where
        std140 and Metal would disagree."""
        offsets, end = [], 0
        for before, each in zip((None, *self.fields), self.fields, strict=False):
            if each.count and each.element.itemsize % 16:
                raise ValueError(f"{self.name}.{each.name}: an array's elements must have whole 16 bytes")
            if before is not None and before.type == "vec3" and each.alignment < 16:
                raise ValueError(f"{self.name}.{each.name}: must not share the 16 bytes of the vec3 before it")
            offsets.append(_aligned(end, each.alignment))
            end = offsets[-1] + each.size
        return [*offsets, _aligned(end, 16)]

    @cached_property
    def dtype(self) -> np.dtype:
        """The layout of the host."""
        formats = [np.dtype((each.element, (each.count,))) if each.count else each.element for each in self.fields]
        *offsets, size = self.offsets
        names = [each.name for each in self.fields]
        return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": size})

    @cached_property
    def glsl(self) -> str:
        """The struct's declaration, gaps filled."""
        lines, ends = [], [offset + each.size for offset, each in zip(self.offsets, self.fields, strict=False)]
        for each, end, following in zip(self.fields, ends, self.offsets[1:], strict=True):
            lines += [each.glsl, *(f"int padding_{gap};" for gap in range(end, following, 4))]
        return f"struct {self.name} {{ {' '.join(lines)} }};\n"

    def needs(self) -> list[Struct]:
        """The structs that its fields are of, each once and after those that it needs itself."""
        found: list[Struct] = []
        for each in self.fields:
            if isinstance(each.type, Struct):
                found += [more for more in (*each.type.needs(), each.type) if more not in found]
        return found

    def filled(self, **values: Any) -> np.ndarray:
        """A block with these values; arrays are filled from the front. Raises TypeError for a field that is not
        declared, or one that is missing and not optional."""
        unknown = sorted(values.keys() - {each.name for each in self.fields})
        missing = [each.name for each in self.fields if each.name not in values and not each.optional]
        if unknown or missing:
            raise TypeError(f"{self.name} has no fields {unknown}, and needs {missing}")
        block = np.zeros((), self.dtype)
        for name, value in values.items():
            value = np.asarray(value)
            block[name][tuple(slice(extent) for extent in value.shape)] = value
        return block


def _aligned(offset: int, alignment: int) -> int:
    return -(-offset // alignment) * alignment


def typedefs(blocks: Iterable[Struct]) -> str:
    """GLSL of the blocks and of all structs in them."""
    found: list[Struct] = []
    for block in blocks:
        found += [each for each in (*block.needs(), block) if each not in found]
    return "".join(each.glsl for each in found)
