"""3MF files: placed parts, units, and archives made to do harm."""

import io
import zipfile

import numpy as np
import pytest

from contactbench.pipeline.mesh import MeshError, MeshWarning, load_probe
from contactbench.pipeline.mesh.parse import LARGEST_FACETS

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
MESH = (
    "<mesh><vertices>"
    + "".join(
        f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in [(0, 0, 0), (50, 0, 0), (0, 50, 0), (0, 0, 50)]
    )
    + "</vertices><triangles>"
    + "".join(
        f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    )
    + "</triangles></mesh>"
)
OBJECT = f'<object id="1" type="model">{MESH}</object>'


def model(objects: str = OBJECT, items: str = '<item objectid="1"/>', attributes: str = "") -> str:
    return (
        f'<?xml version="1.0"?><model {attributes} xmlns="{CORE}" xmlns:p="http://example.org/production">'
        f"<resources>{objects}</resources><build>{items}</build></model>"
    )


def packed(
    text: str | bytes, name: str = "3D/3dmodel.model", how: int = zipfile.ZIP_DEFLATED, **others: str
) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", how) as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr(name, text)
        for other, content in others.items():
            archive.writestr(f"3D/Objects/{other}.model", content)
    return out.getvalue()


def refuse(path, message: str, **options) -> None:
    with pytest.raises(MeshError, match=message) as caught:
        load_probe(path, **options)
    assert str(path) in str(caught.value)


def test_a_part(write):
    probe = load_probe(write("a.3mf", packed(model())))
    assert (len(probe.faces), probe.size) == (4, 0.05)
    assert probe.health.sentences == ()


@pytest.mark.parametrize(
    ("unit", "metres"),
    [
        ("millimeter", 0.05),
        ("centimeter", 0.5),
        ("inch", 1.27),
        ("micron", None),
        ("meter", None),
        ("foot", None),
    ],
)
def test_the_stated_unit_is_used(write, unit, metres):
    path = write("a.3mf", packed(model(attributes=f'unit="{unit}"')))
    if metres is None:
        with pytest.warns(MeshWarning, match="give --units.*The file declares .* is impossible"):
            load_probe(path)
    else:
        assert load_probe(path).size == pytest.approx(metres)


def test_a_unit_that_is_given_counts_and_the_stated_one_is_told(write):
    path = write("a.3mf", packed(model(attributes='unit="inch"')))
    with pytest.warns(MeshWarning, match="states inches, but you asked for millimetres, which are used"):
        assert load_probe(path, "mm").size == pytest.approx(0.05)
    assert load_probe(path, "in").size == pytest.approx(1.27)


def test_parts_are_placed_by_components_and_items(write):
    # The component shifts by 100 in x, then the item turns x into y and shifts by 7 in z.
    objects = OBJECT + (
        '<object id="2"><components><component objectid="1" transform="1 0 0 0 1 0 0 0 1 100 0 0"/>'
        "</components></object>"
    )
    items = '<item objectid="2" transform="0 1 0 -1 0 0 0 0 1 0 0 7"/>'
    probe = load_probe(write("a.3mf", packed(model(objects, items))))
    np.testing.assert_allclose(probe.bounds * 1000, [[-50, 100, 7], [0, 150, 57]], atol=1e-9)
    assert probe.health.outward is True


def test_parts_in_other_models_of_the_archive(write):
    # As slicers write them: the build takes an object of the first model, which takes one of another.
    objects = (
        '<object id="2"><components><component p:path="/3D/Objects/part.model" objectid="7"'
        ' transform="1 0 0 0 1 0 0 0 1 100 0 0"/></components></object>'
    )
    inner = (
        '<object id="7"><components><component objectid="1" transform="1 0 0 0 1 0 0 0 1 0 10 0"/></components>'
        f"</object>{OBJECT}"
    )
    data = packed(model(objects, '<item objectid="2"/>'), part=model(inner, ""))
    probe = load_probe(write("a.3mf", data))
    np.testing.assert_allclose(probe.bounds * 1000, [[100, 10, 0], [150, 60, 50]], atol=1e-9)


def test_models_that_take_parts_from_each_other_are_refused(write):
    placed = '<component p:path="/3D/Objects/part.model" objectid="1"/>'
    objects = f'<object id="1"><components>{placed}</components></object>'
    back = objects.replace("Objects/part", "3dmodel")
    refuse(
        write("a.3mf", packed(model(objects), part=model(back, ""))), "nests or repeats its objects too often"
    )


def test_a_mirrored_part_keeps_its_outside(write):
    items = '<item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 0"/>'
    probe = load_probe(write("a.3mf", packed(model(items=items))))
    assert probe.health.outward is True
    assert probe.bounds[0, 0] == pytest.approx(-0.05)


def test_only_what_the_build_lists_is_there(write):
    items = '<item objectid="1"/><item objectid="1" transform="1 0 0 0 1 0 0 0 1 200 0 0"/>'
    with pytest.warns(MeshWarning, match="2 separate parts"):
        assert len(load_probe(write("a.3mf", packed(model(items=items)))).faces) == 8
    refuse(write("b.3mf", packed(model(items=""))), "builds no triangles")


@pytest.mark.parametrize(
    ("space", "read"),
    [
        ("http://schemas.3mf.io/3dmanufacturing/booleans/2023/07", False),
        ("http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02", False),
        ("http://schemas.microsoft.com/3dmanufacturing/production/2015/06", True),
        ("http://schemas.microsoft.com/3dmanufacturing/material/2015/02", True),
    ],
)
def test_extensions_that_a_file_requires(write, space, read):
    path = write("a.3mf", packed(model(attributes=f'xmlns:e="{space}" requiredextensions="p e"').replace(
        "http://example.org/production", "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
    )))  # fmt: skip
    if read:
        assert load_probe(path).size == 0.05
    else:
        refuse(
            path, f"needs the extension '{space}', which is not supported: export the part as plain triangles"
        )


def test_supports_and_items_that_are_not_printed_are_left_out_and_told(write):
    aside = 'transform="1 0 0 0 1 0 0 0 1 100 0 0"'
    objects = OBJECT + OBJECT.replace('id="1" type="model"', 'id="2" type="support"')
    items = f'<item objectid="1"/><item objectid="2" {aside}/><item objectid="1" printable="0" {aside}/>'
    with pytest.warns(MeshWarning, match=r"Supports .*\(objects: 1\).*as not printed .*\(items: 1\)"):
        probe = load_probe(write("a.3mf", packed(model(objects, items))))
    assert (len(probe.faces), probe.size) == (4, 0.05)


def test_parts_in_another_unit_than_the_build(write):
    placed = '<component p:path="/3D/Objects/part.model" objectid="1"/>'
    objects = f'<object id="2"><components>{placed}</components></object>'
    inches = model(attributes='unit="inch"', items="")
    data = packed(model(objects, '<item objectid="2"/>'), part=inches)
    with pytest.warns(MeshWarning, match=r"state another unit \(inch\) than its build \(millimeter\)"):
        assert load_probe(write("a.3mf", data)).size == 0.05
    small = inches.replace('"50"', '"2"')
    path = write("b.3mf", packed(model(objects, '<item objectid="2"/>'), part=small))
    with pytest.warns(
        MeshWarning, match="50.8 mm if they are inches.*declares millimetres, but 2 mm is impossible"
    ):
        load_probe(path)
    with pytest.warns(MeshWarning, match="states millimetres, but you asked for inches"):
        assert load_probe(path, "in").size == pytest.approx(0.0508)


def test_elements_of_other_namespaces_are_left_alone(write):
    odd = OBJECT.replace("<vertices>", '<vertices><p:vertex x="hello"/>')
    assert len(load_probe(write("a.3mf", packed(model(odd)))).faces) == 4


def test_names_may_be_in_another_case(write):
    assert len(load_probe(write("a.3mf", packed(model(), "/3d/3DModel.MODEL"))).faces) == 4
    assert len(load_probe(write("b.3mf", packed(model(), "3D/part.model"))).faces) == 4


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"hello", "not a readable 3MF archive"),
        (packed(model())[:-30], "not a readable 3MF archive"),
        (packed(model(), "other.txt"), "has no 3D/3dmodel.model"),
        (packed(model(), how=zipfile.ZIP_BZIP2), "encrypted or packed in an unusual way"),
        (packed(model()[:-20]), "not valid XML"),
        (packed(model().replace("<build>", "<build>&nosuch;")), "not valid XML"),
        (packed(model(attributes='unit="cubit"')), "unknown unit 'cubit'"),
        (packed(model().replace('x="50"', 'x="fifty"')), "a <vertex> of the 3MF model has no number"),
        (
            packed(model().replace('x="50"', 'x="nan"')),
            "vertex 2 is .nan, nan, nan.; 1 of 4 vertices is not finite",
        ),
        (packed(model().replace('x="50"', "")), "a <vertex> of the 3MF model has no 'x'"),
        (packed(model().replace('v1="1"', 'v1="4"')), "refers to a vertex that does not exist"),
        (packed(model().replace('v1="1"', 'v1="-1"')), "refers to a vertex that does not exist"),
        (packed(model().replace('v1="1"', f'v1="{10**30}"')), "a <triangle> of the 3MF model has no number"),
        (packed(model(items='<item objectid="9"/>')), "places the object '9', which it does not contain"),
        (packed(model(items='<item objectid="1" transform="1 0 0"/>')), "not twelve finite numbers"),
        (
            packed(model(items='<item objectid="1" transform="1 0 0 0 1 0 0 0 1 0 0 inf"/>')),
            "not twelve finite",
        ),
        (
            packed(model(items='<item objectid="1" p:path="/3D/other.model"/>')),
            "lacks the model '3d/other.model' that it takes parts from",
        ),
        (packed("<!DOCTYPE a [<!ENTITY b 'c'>]>" + model().partition("?>")[2]), "declares a document type"),
    ],
)
def test_damaged_or_hostile(write, data, message):
    refuse(write("a.3mf", data), message)


def test_an_archive_that_unpacks_to_far_more(write):
    refuse(write("a.3mf", packed(model() + " " * 40_000_000)), "unpacks to far more than a model needs")


def test_objects_that_hold_themselves_or_each_other_many_times(write):
    loop = '<object id="1"><components><component objectid="1"/></components></object>'
    refuse(write("a.3mf", packed(model(loop))), "nests or repeats its objects too often")
    copies = "".join(
        f'<object id="{i}"><components>{f"""<component objectid="{i + 1}"/>""" * 10}</components></object>'
        for i in range(1, 8)
    )
    nested = copies + OBJECT.replace('id="1"', 'id="8"')
    refuse(write("b.3mf", packed(model(nested))), "nests or repeats its objects too often")


def test_copies_count_towards_the_limit_of_facets(write):
    mesh = MESH.replace("</triangles>", '<triangle v1="0" v2="1" v3="2"/>' * 5000 + "</triangles>")
    items = '<item objectid="1"/>' * (LARGEST_FACETS // 5000)
    refuse(
        write("a.3mf", packed(model(f'<object id="1">{mesh}</object>', items))), "more than 4000000 facets"
    )
