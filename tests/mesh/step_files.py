"""STEP files of boxes and cylinders, alone or placed in an assembly, written entity by entity."""

from __future__ import annotations

_HEAD = (
    "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
    "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
)
_CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
# Corners of each side of a box, seen from outside.
_SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


class Step:
    """What has been written; lengths are in the unit."""

    def __init__(self, inches: bool = False) -> None:
        self.lines: list[str] = []
        length = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
        if inches:
            long = self.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)")
            factor = self.add(f"LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),{length})")
            length = self.add(f"(CONVERSION_BASED_UNIT('INCH',{factor})\nLENGTH_UNIT()NAMED_UNIT({long}))")
        angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
        self.context = self.add(
            f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle}))"
            "REPRESENTATION_CONTEXT('',''))"
        )
        application = self.add("APPLICATION_CONTEXT('')")
        self.product_context = self.add(f"PRODUCT_CONTEXT('',{application},'mechanical')")
        self.design = self.add(f"PRODUCT_DEFINITION_CONTEXT('',{application},'design')")
        self.frame = self.axes((0, 0, 0))

    def __str__(self) -> str:
        return _HEAD + "".join(self.lines) + "ENDSEC;\nEND-ISO-10303-21;\n"

    def add(self, entity: str) -> str:
        self.lines.append(f"#{len(self.lines) + 1}={entity};\n")
        return f"#{len(self.lines)}"

    def triple(self, kind: str, values) -> str:
        return self.add(f"{kind}('',({','.join(str(float(each)) for each in values)}))")

    def axes(self, at, z=(0, 0, 1), x=(1, 0, 0)) -> str:
        parts = self.triple("CARTESIAN_POINT", at), self.triple("DIRECTION", z), self.triple("DIRECTION", x)
        return self.add(f"AXIS2_PLACEMENT_3D('',{','.join(parts)})")

    def product(self, name: str, items: str, kind: str) -> tuple[str, str]:
        """Write a product of a shape; its definition and its representation."""
        product = self.add(f"PRODUCT('{name}','{name}','',({self.product_context}))")
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
        definition = self.add(f"PRODUCT_DEFINITION('','',{formation},{self.design})")
        shape = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
        representation = self.add(f"{kind}('',({items}),{self.context})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION({shape},{representation})")
        return definition, representation

    def box(self, size) -> tuple[str, str]:
        points = [
            self.triple("CARTESIAN_POINT", [a * b for a, b in zip(corner, size, strict=True)])
            for corner in _CORNERS
        ]
        faces = []
        for side in _SIDES:
            loop = self.add(f"POLY_LOOP('',({','.join(points[each] for each in side)}))")
            bound = self.add(f"FACE_OUTER_BOUND('',{loop},.T.)")
            across = next(k for k in range(3) if len({_CORNERS[each][k] for each in side}) == 1)
            z, at = [0, 0, 0], [a * b for a, b in zip(_CORNERS[side[0]], size, strict=True)]
            z[across] = 1 if at[across] else -1
            plane = self.add(f"PLANE('',{self.axes(at, z, [z[2], z[0], z[1]])})")
            faces.append(self.add(f"FACE_SURFACE('',({bound}),{plane},.T.)"))
        shell = self.add(f"CLOSED_SHELL('',({','.join(faces)}))")
        solid = self.add(f"FACETED_BREP('',{shell})")
        return self.product("box", f"{self.frame},{solid}", "FACETED_BREP_SHAPE_REPRESENTATION")

    def cylinder(self, radius, height) -> tuple[str, str]:
        ends = [self.triple("CARTESIAN_POINT", (radius, 0, z)) for z in (0, height)]
        low, high = (self.add(f"VERTEX_POINT('',{end})") for end in ends)
        frames = self.frame, self.axes((0, 0, height))
        rims = [self.add(f"CIRCLE('',{frame},{float(radius)})") for frame in frames]
        along = self.add(f"VECTOR('',{self.triple('DIRECTION', (0, 0, 1))},1.)")
        seam = self.add(f"LINE('',{ends[0]},{along})")
        bottom, top, side = (
            self.add(f"EDGE_CURVE('',{a},{b},{curve},.T.)")
            for a, b, curve in ((low, low, rims[0]), (high, high, rims[1]), (low, high, seam))
        )
        faces = []
        for surface, same, edges in (
            (
                f"CYLINDRICAL_SURFACE('',{frames[0]},{float(radius)})",
                "T",
                [(bottom, "T"), (side, "T"), (top, "F"), (side, "F")],
            ),
            (f"PLANE('',{frames[0]})", "F", [(bottom, "F")]),
            (f"PLANE('',{frames[1]})", "T", [(top, "T")]),
        ):
            oriented = [self.add(f"ORIENTED_EDGE('',*,*,{edge},.{way}.)") for edge, way in edges]
            bound = self.add(
                f"FACE_BOUND('',{self.add(f'EDGE_LOOP({chr(39) * 2},({chr(44).join(oriented)}))')},.T.)"
            )
            faces.append(self.add(f"ADVANCED_FACE('',({bound}),{self.add(surface)},.{same}.)"))
        solid = self.add(
            f"MANIFOLD_SOLID_BREP('',{self.add(f'CLOSED_SHELL({chr(39) * 2},({chr(44).join(faces)}))')})"
        )
        return self.product("cylinder", f"{self.frame},{solid}", "ADVANCED_BREP_SHAPE_REPRESENTATION")

    def assembly(self, *placed: tuple[tuple[str, str], str]) -> None:
        """Place parts; each goes with the axes that it is put on."""
        whole = ",".join([self.frame, *(axes for _, axes in placed)])
        definition, representation = self.product("assembly", whole, "SHAPE_REPRESENTATION")
        for (part, shape), axes in placed:
            use = self.add(f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{axes}','','',{definition},{part},$)")
            move = self.add(f"ITEM_DEFINED_TRANSFORMATION('','',{self.frame},{axes})")
            relation = self.add(
                f"(REPRESENTATION_RELATIONSHIP('','',{shape},{representation})"
                f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION({move})SHAPE_REPRESENTATION_RELATIONSHIP())"
            )
            used = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{use})")
            self.add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({relation},{used})")
