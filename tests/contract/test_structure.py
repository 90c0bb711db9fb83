"""The numbers of a description: ModelStructure lists what was measured and nothing else, and whoever adds, moves or
removes a variable numbers nothing by hand."""

import re
import sys

import pytest
from support.paths import ROOT

sys.path.insert(0, str(ROOT / "cmake"))
from description.measuring import measured
from description.numbering import numbered

TEXT = (ROOT / "modelDescription.xml").read_text(encoding="utf-8")
LOADS = {"F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3", "M_brake"}
NEW = """    <ScalarVariable name="drag" causality="parameter" variability="fixed" initial="exact"
      description="Added first"><Real unit="m" start="0"/></ScalarVariable>
"""


@pytest.fixture(scope="module")
def depends(fmu_path):
    return measured(fmu_path)


def test_the_measurement_finds_the_dependencies_that_the_equations_have(depends):
    start, now = depends["InitialUnknowns"], depends["Outputs"]
    assert start["theta"] == {"theta_start"} and start["Z_O"] == {"r_0", "r", "theta_start"}
    assert start["tau"] > LOADS | {"s", "friction_law", "omega_s", "J_x", "J_y", "g"}
    assert now["lambda_3"] > LOADS and now["theta"] == {"theta"} and now["omega_z"] == {"omega_z"}
    assert depends["Derivatives"]["phi_dot"] == {"theta", "psi_dot", "omega_z"}


def test_the_description_is_numbered_and_lists_exactly_the_dependencies_that_are_measured(depends):
    assert numbered(TEXT, depends) == TEXT, "run scripts/variables"
    without = {**depends, "Outputs": {**depends["Outputs"], "theta": {"M_1"}}}
    assert numbered(TEXT, without) != TEXT  # a false algebraic loop would be seen


def index_of(text: str, name: str) -> int:
    return 1 + int(re.search(rf'name="{name}" valueReference="(\d+)"', text)[1])


def without_numbers(text: str) -> str:
    return re.sub(r'( guid| valueReference|index|dependencies| derivative)="[^"]*"', "", text)


def test_a_variable_that_comes_or_goes_changes_numbers_alone(depends):
    with_new = TEXT.replace("  <ModelVariables>\n", f"  <ModelVariables>\n{NEW}")
    added = numbered(with_new)
    assert 'name="drag" valueReference="0"' in added and 'name="m" valueReference="1"' in added
    assert without_numbers(added) == without_numbers(with_new)
    rows = re.compile(r'index="(\d+)" dependencies="([^"]*)"')
    before, after = ([[int(i) for i in " ".join(row).split()] for row in rows.findall(text)] for text in (TEXT, added))
    assert [[i + 1 for i in row] for row in before] == after
    removed = re.sub(r' *<ScalarVariable name="drag".*?</ScalarVariable>\n', "", added, flags=re.DOTALL)
    assert numbered(removed) == TEXT != removed
    added_again = numbered(removed, {"Outputs": depends["Outputs"]})
    assert f'index="{index_of(TEXT, "theta")}"/>' in added_again  # what was not measured is not stated


def test_states_and_derivatives_are_numbered_by_name():
    height = index_of(TEXT, "Z_O_dot")
    moved = re.sub(r'(name="Z_O_dot".*?<Real )', r'\1derivative="Z_O" ', TEXT, count=1, flags=re.DOTALL)
    states = numbered(moved.replace("  <ModelVariables>\n", f"  <ModelVariables>\n{NEW}"))
    assert f'derivative="{index_of(TEXT, "Z_O") + 1}"' in states
    section = re.search(r"<Derivatives>.*</Derivatives>", states, re.DOTALL)[0]
    order = re.findall(r"<!-- (\w+) -->", section)
    before = TEXT[TEXT.index("<Derivatives>") : TEXT.index("</Derivatives>")]
    assert order == [*re.findall(r"<!-- (\w+) -->", before), "Z_O_dot"]
    assert f'<Unknown index="{height + 1}"/><!-- Z_O_dot -->' in section
    assert numbered(states) == states


OF_X_O = f'dependencies="{index_of(TEXT, "X_O")}"'
FAULTY = [('valueReference="1"', 'valueReference="0"', "m and r_0 have one valueReference")]
FAULTY += [('name="r_0"', 'name="m"', "two variables of one name")]
FAULTY += [(OF_X_O, 'dependencies="mass"', "refers to mass, which is none of its variables")]


@pytest.mark.parametrize(("old", "new", "sentence"), FAULTY)
def test_a_description_that_cannot_be_numbered_is_refused_with_a_sentence(old, new, sentence):
    with pytest.raises(SystemExit, match=sentence):
        numbered(TEXT.replace(old, new, 1))
