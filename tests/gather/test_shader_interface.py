# SPDX-License-Identifier: GPL-3.0-or-later
"""The blocks between host and shaders: shaders read declared fields alone, none is declared in vain or left unfilled,
and numpy lays them out as GLSL reads them."""

import re

import gpu
import numpy as np
import pytest

# Of GLSL and of the Metal language: none may be the name of a field.
RESERVED = {
    *"active array atomic buffer centroid coherent common const constant device discard filter fixed flat".split(),
    *"fragment half highp image in inline input interface invariant kernel layout long lowp mediump noise".split(),
    *"object out output packed partition patch precise precision public readonly resource restrict sample".split(),
    *"sampler shared short signed sizeof smooth subroutine superp template texture thread threadgroup this".split(),
    *"typedef uniform union unsigned using varying vertex visible volatile writeonly".split(),
}


def text_of(light, made_of):
    """The GLSL of a pass without comments."""
    files = ("common/common", *made_of.files)
    text = "\n".join((light.device.SHADERS / f"{file}.glsl").read_text() for file in files)
    return re.sub(r"//.*", "", text)


def read_fields(text, block):
    """Names of the block's fields that a shader's text reads."""
    return set(re.findall(rf"\b{block}\.(\w+)", text))


def test_shaders_read_the_fields_that_are_declared(light):
    """All of a pass's options, and of the blocks that passes share no other fields than theirs."""
    camera_fields = {field.name for field in light.shader_interface.VIEW_CAMERA.fields}
    level_fields = {field.name for field in light.shader_interface.LEVEL.fields}
    for name, made_of in light.shader_interface.PASSES.items():
        text = text_of(light, made_of)
        for block in ("frame", "views", "options"):
            fields = made_of.blocks[block].fields if block in made_of.blocks else ()
            assert read_fields(text, block) <= {field.name for field in fields}, f"{name}: not declared in {block}"
        assert {field.name for field in made_of.options} <= read_fields(text, "options"), f"{name}: not read"
        assert set(re.findall(r"\bviews\.cameras\[[^]]*\]\.(\w+)", text)) <= camera_fields
        assert set(re.findall(r"\bframe\.levels\[[^]]*\]\.(\w+)", text)) <= level_fields


def test_every_field_of_the_shared_blocks_is_read(light):
    text = "\n".join(text_of(light, made_of) for made_of in light.shader_interface.PASSES.values())
    for block in (light.shader_interface.FRAME, light.shader_interface.VIEWS):
        assert {field.name for field in block.fields} == read_fields(text, block.name.lower())


def test_every_texture_of_a_pass_is_used(light):
    for name, made_of in light.shader_interface.PASSES.items():
        text = text_of(light, made_of)
        for texture in (*made_of.reads, made_of.writes):
            assert re.search(rf"\b{texture}\b", text) or texture in made_of.defines.values(), f"{name}: {texture}"


def test_no_name_is_reserved(light):
    interface = light.shader_interface
    structs = [interface.FRAME, interface.VIEWS]
    structs += [made.blocks["options"] for made in interface.PASSES.values() if made.options]
    structs += [nested for struct in structs for nested in struct.needs()]
    assert not {field.name for struct in structs for field in struct.fields} & RESERVED


def test_a_pass_must_be_given_all_of_its_fields(light):
    """And no others, nor another's blocks: before anything runs."""
    interface = light.shader_interface
    for made_of in interface.PASSES.values():
        blocks = {name: np.zeros((), struct.dtype) for name, struct in made_of.blocks.items() if name != "options"}
        given = {"frame": None, "views": None} | blocks
        options = {field.name: 0 for field in made_of.options}
        assert made_of.filled(given["frame"], given["views"], options).keys() == made_of.blocks.keys()
        for missing in options:
            with pytest.raises(TypeError, match=missing):
                made_of.filled(given["frame"], given["views"], {name: 0 for name in options if name != missing})
        with pytest.raises(TypeError, match="nobody"):
            made_of.filled(given["frame"], given["views"], options | {"nobody": 0})
        for block in ("frame", "views"):
            swapped = given | {block: None if block in blocks else np.zeros((), interface.FRAME.dtype)}
            with pytest.raises(TypeError, match="has the blocks"):
                made_of.filled(swapped["frame"], swapped["views"], options)


def test_dispatch_refuses_what_does_not_fit(light):
    frame, views = (np.zeros((), block.dtype) for block in (light.shader_interface.FRAME, light.shader_interface.VIEWS))
    with pytest.raises(TypeError, match="strength"):
        light.device.dispatch("smooth", {}, (1, 1), frame=frame, views=views, step=1, is_last=True, has_world=False)
    with pytest.raises(TypeError, match="rays"):
        light.device.dispatch("upsample", {}, (1, 1), frame=frame, last_level=1, rays=1)


def leaves(struct, prefix):
    """(name in GLSL, indices in numpy) of each number in a block, in order."""
    for field in struct.fields:
        for index in range(max(field.count, 1)):
            name = f"{prefix}.{field.name}" + (f"[{index}]" if field.count else "")
            at = (field.name, index) if field.count else (field.name,)
            if not isinstance(field.type, str):
                yield from ((inner, at + more) for inner, more in leaves(field.type, name))
                continue
            for part in np.ndindex(field.element.shape):
                yield name + "".join(f"[{k}]" for k in part), at + part


def number_at(block, at):
    for key in at:
        block = block[key]
    return float(block)


def filled_at_random(struct, seed=0):
    """A block of small whole numbers, other in every field."""
    rng, block = np.random.default_rng(seed), np.zeros((), struct.dtype)

    def fill(array):
        if array.dtype.names is None:
            array[...] = rng.integers(1, 1000, array.shape)
        for name in array.dtype.names or ():
            fill(array[name])

    fill(block)
    return block


def read_by_glsl(light, struct, block):
    """The numbers of a block as a shader reads them, in the order of leaves()."""
    names = [name for name, _ in leaves(struct, "block")]
    info = gpu.types.GPUShaderCreateInfo()
    info.typedef_source(light.std140.typedefs([struct]))
    info.uniform_buf(0, struct.name, "block")
    info.image(0, "RGBA32F", "FLOAT_2D", "found", qualifiers={"WRITE"})
    info.local_group_size(1, 1, 1)
    stores = [f"imageStore(found, ivec2({k}, 0), vec4(float({name})));" for k, name in enumerate(names)]
    info.compute_source("void main()\n{\n" + "\n".join(stores) + "\n}")
    shader, found = gpu.shader.create_from_info(info), light.device.texture(len(names), 1)
    buffer = gpu.types.GPUUniformBuf(block.tobytes())
    shader.bind()
    shader.uniform_block("block", buffer)
    shader.image("found", found.handle)
    gpu.compute.dispatch(shader, 1, 1, 1)
    gpu.shader.unbind()
    return light.device.read(found)[0, :, 0].tolist()


def example(light):
    """A block of every type, with gaps of every size and with arrays."""
    field, struct = light.std140.Field, light.std140.Struct
    inner = struct("Inner", (field("a", "int", ""), field("b", "vec2", ""), field("c", "float", "")))
    types = [*light.std140.TYPES, "float", "vec4", "uint", "ivec2", "bool", "mat4", "int"]
    fields = [field(f"f{k}", kind, "") for k, kind in enumerate(types) if kind != "vec3"]
    arrays = [field("g", "vec4", "", 3), field("h", inner, "", 2), field("i", "int", ""), field("j", inner, "")]
    return struct(
        "Example", (*fields, *arrays, field("k", "int", ""), field("l", "vec3", ""), field("m", "mat4", "", 2))
    )


def test_numpy_lays_blocks_out_as_glsl_reads_them(light):
    interface = light.shader_interface
    options = [made.blocks["options"] for made in interface.PASSES.values() if made.options]
    for struct in (example(light), interface.FRAME, interface.VIEWS, *dict.fromkeys(options)):
        block = filled_at_random(struct)
        expected = [number_at(block, at) for _, at in leaves(struct, "block")]
        assert read_by_glsl(light, struct, block) == expected, struct


def test_offsets_are_those_of_std140(light):
    """The example in section 7.6.2.2 of the OpenGL 4.6 specification, as far as its types are used here."""
    field, struct = light.std140.Field, light.std140.Struct
    inner = struct("Inner", (field("d", "int", ""), field("e", "ivec2", "")))
    a_to_g = [field("a", "float", ""), field("b", "vec2", ""), field("c", "vec3", ""), field("f", inner, "")]
    made = struct("Example", (*a_to_g, field("g", "float", ""), field("h", "vec4", "", 2), field("i", "mat4", "")))
    assert made.offsets == [0, 8, 16, 32, 48, 64, 96, 160]
    assert inner.offsets == [0, 8, 16]
    assert [made.dtype.fields[name][1] for name in made.dtype.names] == made.offsets[:-1]
    assert made.dtype.itemsize == 160


def test_what_metal_would_lay_out_otherwise_is_refused(light):
    field, struct = light.std140.Field, light.std140.Struct
    for fields in (
        (field("a", "vec3", ""), field("b", "float", "")),
        (field("a", "vec3", ""), field("b", "vec2", "")),
        (field("a", "int", "", 4),),
        (field("a", "vec3", "", 2),),
    ):
        with pytest.raises(ValueError):
            assert struct("Bad", fields).offsets is None


# Bytes and alignment of types in the Metal Shading Language.
METAL = {"int": (4, 4), "uint": (4, 4), "float": (4, 4), "vec2": (8, 8), "ivec2": (8, 8), "vec3": (16, 16)}
METAL |= {"vec4": (16, 16), "mat4": (64, 16)}


def metal_offsets(light, struct):
    """{field: its offset, "": the size} of a struct's text by the rules of C, which Metal follows."""
    known, offsets = dict(METAL), {}
    for name, body in re.findall(r"struct (\w+) \{ (.*?) \};", light.std140.typedefs([struct])):
        end, largest, offsets = 0, 1, {}
        for kind, field, count in re.findall(r"(\w+) (\w+)(?:\[(\d+)\])?;", body):
            size, alignment = known[kind]
            offsets[field] = -(-end // alignment) * alignment
            end, largest = offsets[field] + size * int(count or 1), max(largest, alignment)
        offsets[""] = -(-end // largest) * largest
        known[name] = offsets[""], largest
    return offsets


def test_metal_lays_blocks_out_alike(light):
    interface = light.shader_interface
    options = [made.blocks["options"] for made in interface.PASSES.values() if made.options]
    for struct in (example(light), interface.FRAME, interface.VIEWS, *options):
        for declared in (*struct.needs(), struct):
            offsets = metal_offsets(light, declared)
            expected = dict(zip([field.name for field in declared.fields] + [""], declared.offsets, strict=True))
            assert {name: offsets[name] for name in expected} == expected, declared.name
