"""What is packed for a release: licences word for word, one library for both of Apple's processors, a GUID that tells.

No part of the paper. The cross compiler is not needed here; scripts/release checks the libraries themselves.
"""

import shutil
import struct
import subprocess
import sys
from pathlib import Path

import fmpy
import pytest
from support.paths import ROOT, build_folder

sys.path.insert(0, str(ROOT / "cmake"))
import pack_fmu
from description.numbering import guid_of

from release import fmu as released

HEADERS = Path(fmpy.__file__).parent / "c-code"
CLAUSES = (
    "Redistributions of source code must retain the above copyright notice",
    "Redistributions in binary form must reproduce the above copyright notice",
    "THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS",
    "EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE",
)
PAGE = 1 << 14
X86_64, ARM64 = 0x01000007, 0x0100000C
DESCRIPTION = (ROOT / "modelDescription.xml").read_text(encoding="utf-8")


def contains(text: str, piece: str) -> bool:
    return " ".join(piece.split()) in " ".join(text.split())


def licence(fmu: str, name: str) -> str:
    return (Path(fmu) / "licenses" / name).read_text(encoding="utf-8")


def test_the_notice_of_the_fmi_headers_is_that_of_the_headers_word_for_word(fmu):
    notice = licence(fmu, "fmi-headers-notice.txt")
    for header in ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h"):
        assert contains((HEADERS / header).read_text(encoding="utf-8"), notice), header
    assert notice.split()[:2] == ["Copyright", "(C)"]
    assert all(contains(notice, clause) for clause in CLAUSES)
    changed = notice.replace("must reproduce", "should reproduce")  # the partner
    assert not contains((HEADERS / "fmi2Functions.h").read_text(encoding="utf-8"), changed)


def test_the_licence_of_eigen_is_packed_in_full_beside_ours_and_that_of_sundials(fmu):
    assert contains(licence(fmu, "license.txt"), "wheel.fmu founders")
    assert contains(licence(fmu, "sundials-license.txt"), "Lawrence Livermore")
    text = licence(fmu, "eigen-license.txt")
    assert contains(text, "Mozilla Public License") and contains(text, '1.1. "Contributor"')
    assert contains(text, "Limitation of Liability") and contains(text, "Exhibit A - Source Code Form License Notice")
    notice = licence(fmu, "eigen-notice.txt")
    assert contains(notice, "Mozilla Public")
    assert not contains(notice, "Limitation of Liability")  # the partner: our own words about it


@pytest.mark.parametrize("left_out", released.LICENCES.values())
def test_a_release_carries_the_licences_of_what_the_cross_compiler_links_in(tmp_path, left_out):
    for name in released.LICENCES.values():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    entries = released.licences(tmp_path)
    assert {f"licenses/{name}-license.txt" for name in ("zig", "musl", "mingw-w64", "libcxx")} == set(entries)
    pack_fmu.pack(entries, tmp_path / "whole.fmu")
    (tmp_path / left_out).unlink()
    with pytest.raises(FileNotFoundError):  # a licence that is not found is not passed over
        pack_fmu.pack(entries, tmp_path / "less.fmu")


def mach_o(processor: int, size: int) -> bytes:
    return struct.pack("<III", released.MACHO_64, processor, 0).ljust(size, bytes([processor & 0xFF]))


def test_the_universal_library_holds_each_processors_library_whole_and_on_its_page():
    libraries = {X86_64: mach_o(X86_64, PAGE + 5), ARM64: mach_o(ARM64, 3 * PAGE - 1)}
    joined = released.universal([*libraries.values()])
    magic, count = struct.unpack_from(">II", joined)
    assert (magic, count) == (0xCAFEBABE, 2)
    for k, (processor, library) in enumerate(libraries.items()):
        kind, _, offset, size, alignment = struct.unpack_from(">5I", joined, 8 + 20 * k)
        assert (kind, size, offset % PAGE, 1 << alignment) == (processor, len(library), 0, PAGE)
        assert joined[offset : offset + size] == library
        assert joined[offset + 1 : offset + 1 + size] != library
    with pytest.raises(ValueError, match="not a 64-bit Mach-O"):
        released.universal([b"\x7fELF".ljust(64, b"\0")])


def test_the_guid_is_the_digest_of_the_variables(description):
    assert description.guid == guid_of(DESCRIPTION), "run ./scripts/variables"


CHANGES = {"name": ("theta_dot", "theta_rate"), "valueReference": ("30", "99"), "start": ("20", "21")}
CHANGES |= {"unit": ("N.m", "N"), "variability": ("tunable", "fixed"), 'min="1" max': ("4", "5")}
CHANGES |= {"maxOutputDerivativeOrder": ("1", "0"), "dependencies": ("32", "1"), "numberOfEventIndicators": ("4", "3")}


@pytest.mark.parametrize("attribute", CHANGES)
def test_the_guid_changes_when_a_variable_does(attribute):
    old, new = (f'{attribute}="{value}"' for value in CHANGES[attribute])
    assert old in DESCRIPTION
    changed = DESCRIPTION.replace(old, new, 1)
    assert guid_of(changed) != guid_of(DESCRIPTION)


def test_the_guid_stays_when_only_prose_or_layout_changes():
    prose = DESCRIPTION.replace('description="Mass"', 'description="The mass"').replace("\n  ", "\n    ")
    assert prose != DESCRIPTION
    assert guid_of(prose) == guid_of(DESCRIPTION)


# A project without languages: what cmake/fmi.cmake makes of a machine.
FOLDER_OF = """
cmake_minimum_required(VERSION 3.25)
project(folder LANGUAGES NONE)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
list(APPEND CMAKE_MODULE_PATH "{root}/cmake")
include(fmi)
file(WRITE ${{CMAKE_BINARY_DIR}}/folder ${{wheel_platform}})
"""
# FMPy on an arm machine, where the libraries that it brings for x86-64 cannot be loaded.
ON_ARM = """
import ctypes, platform, sys
load = ctypes.cdll.LoadLibrary
def loads(name):
    if name and "site-packages" in name:
        raise OSError(f"{name}: wrong ELF class")
    return load(name)
platform.machine, ctypes.cdll.LoadLibrary = lambda: "aarch64", loads
import fmpy
assert fmpy.platform_tuple == "aarch64-linux"
assert fmpy.simulate_fmu(sys.argv[1], stop_time=0.1)["time"][-1] == 0.1
"""


def test_a_local_build_on_arm_linux_is_where_fmpy_looks_for_it(tmp_path):
    shutil.copy(ROOT / "modelDescription.xml", tmp_path)
    (tmp_path / "CMakeLists.txt").write_text(FOLDER_OF.format(root=ROOT))
    options = ["-S", tmp_path, "-B", tmp_path, f"-DPython3_EXECUTABLE={sys.executable}"]
    subprocess.run(["cmake", *options], check=True, capture_output=True)
    runs = {}
    for folder in ((tmp_path / "folder").read_text(), "aarch64-linux"):  # that of a release is the partner
        fmu = tmp_path / f"{folder}.fmu"
        pack_fmu.pack(pack_fmu.contents(folder, build_folder() / "wheel.so", {}), fmu)
        runs[folder] = subprocess.run([sys.executable, "-c", ON_ARM, fmu], capture_output=True, text=True, check=False)
    assert [run.returncode for run in runs.values()] == [0, 1], runs
    assert "cannot be simulated on the current platform" in runs["aarch64-linux"].stderr
