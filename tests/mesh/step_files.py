"""STEP files of cylinders, alone or placed in an assembly, written entity by entity."""

_HEAD = "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n"
_UNIT = "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))"
_INCH = """DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)|LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#1)
(CONVERSION_BASED_UNIT('INCH',#3)LENGTH_UNIT()NAMED_UNIT(#2))"""
# Of a cylinder: two rims and a seam, then its side and its ends.
_SOLID = """VERTEX_POINT('',{0})|VERTEX_POINT('',{1})|CIRCLE('',{2},{r})|CIRCLE('',{3},{r})|VECTOR('',{4},1.)
LINE('',{0},{9})|EDGE_CURVE('',{5},{5},{7},.T.)|EDGE_CURVE('',{6},{6},{8},.T.)|EDGE_CURVE('',{5},{6},{10},.T.)
ORIENTED_EDGE('',*,*,{11},.T.)|ORIENTED_EDGE('',*,*,{13},.T.)|ORIENTED_EDGE('',*,*,{12},.F.)
ORIENTED_EDGE('',*,*,{13},.F.)|ORIENTED_EDGE('',*,*,{11},.F.)|ORIENTED_EDGE('',*,*,{12},.T.)
EDGE_LOOP('',({14},{15},{16},{17}))|EDGE_LOOP('',({18}))|EDGE_LOOP('',({19}))
FACE_BOUND('',{20},.T.)|FACE_BOUND('',{21},.T.)|FACE_BOUND('',{22},.T.)
CYLINDRICAL_SURFACE('',{2},{r})|PLANE('',{2})|PLANE('',{3})
ADVANCED_FACE('',({23}),{26},.T.)|ADVANCED_FACE('',({24}),{27},.F.)|ADVANCED_FACE('',({25}),{28},.T.)
CLOSED_SHELL('',({29},{30},{31}))|MANIFOLD_SOLID_BREP('',{32})"""


def _split(entities: str) -> list[str]:
    return entities.replace("\n", "|").split("|")


class Step:
    """What has been written; lengths are in the unit."""

    def __init__(self, inches: bool = False) -> None:
        self.lines: list[str] = []
        unit = [self.add(each) for each in (_UNIT, *_split(_INCH) * inches)][-1]
        self.context = self.add(
            f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT(({unit}))"
            "REPRESENTATION_CONTEXT('',''))"
        )
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

    def product(self, items: str, kind: str) -> tuple[str, str]:
        """Write a product of a shape; its definition and its representation."""
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',{self.add('PRODUCT($,$,$,())')})")
        definition = self.add(f"PRODUCT_DEFINITION('','',{formation},$)")
        shape = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
        representation = self.add(f"{kind}('',({items}),{self.context})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION({shape},{representation})")
        return definition, representation

    def cylinder(self, radius, height) -> tuple[str, str]:
        ends = [self.triple("CARTESIAN_POINT", (radius, 0, z)) for z in (0, height)]
        known = [*ends, self.frame, self.axes((0, 0, height)), self.triple("DIRECTION", (0, 0, 1))]
        for entity in _split(_SOLID):
            known.append(self.add(entity.format(*known, r=float(radius))))
        return self.product(f"{self.frame},{known[-1]}", "ADVANCED_BREP_SHAPE_REPRESENTATION")

    def assembly(self, *placed: tuple[tuple[str, str], str]) -> None:
        """Place parts; each goes with the axes that it is put on."""
        definition, representation = self.product(self.frame, "SHAPE_REPRESENTATION")
        for (part, shape), axes in placed:
            use = self.add(f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{axes}','','',{definition},{part},$)")
            move = self.add(f"ITEM_DEFINED_TRANSFORMATION('','',{self.frame},{axes})")
            relation = self.add(
                f"(REPRESENTATION_RELATIONSHIP('','',{shape},{representation})"
                f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION({move})SHAPE_REPRESENTATION_RELATIONSHIP())"
            )
            use = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{use})")
            self.add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({relation},{use})")
