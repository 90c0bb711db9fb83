"""The library and the archive as files: what they need, export and contain; the same content packs the same."""

import importlib.util
import subprocess
import zipfile
from pathlib import Path

import pytest
from support.paths import ROOT

from contract.call_states import TABLE

pytestmark = pytest.mark.local
# Beside those of the table of call states.
OTHER_FUNCTIONS = {"fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2Instantiate", "fmi2FreeInstance"}


@pytest.fixture(scope="module")
def library(fmu: str) -> Path:
    (path,) = Path(fmu).glob("binaries/*linux*/wheel.so")
    return path


def lines_of(*command: str) -> list[str]:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def needed(library: Path) -> set[str]:
    dynamic = lines_of("readelf", "--dynamic", "--wide", str(library))
    return {line.split("[")[1].rstrip("]") for line in dynamic if "(NEEDED)" in line}


def names(library: Path, which: str) -> set[str]:
    return {line.split()[-1].split("@")[0] for line in lines_of("nm", "--dynamic", f"--{which}-only", str(library))}


def exported(library: Path) -> set[str]:
    return names(library, "defined") - {"wheel_1", "WHEEL"}


def test_the_library_needs_libc_and_libm_only(library):
    assert needed(library) <= {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
    (python,) = [Path(p) for p in [importlib.util.find_spec("numpy.linalg._umath_linalg").origin]]
    assert not needed(python) <= {"libc.so.6", "libm.so.6"}  # the partner: another library of this machine


# Rounded correctly in every libm, as IEEE 754 asks, and cosines are not.
EXACT = {"fabs", "floor", "ceil", "fmax", "fmin", "fmod", "nearbyint", "remainder", "scalbn", "sqrt"}


def of_the_systems_mathematics(library: Path) -> set[str]:
    """What a library takes from libm; perhaps nothing, since some compilers compute a remainder themselves."""
    libms = [line.split()[2] for line in lines_of("ldd", str(library)) if line.split()[0].startswith("libm.")]
    return {name for libm in libms for name in names(library, "undefined") & names(Path(libm), "defined")}


def test_of_the_systems_mathematics_the_libraries_take_only_what_is_exact(library, fmu_path):
    for path in (library, fmu_path.parent / "libwheel_equations.so"):
        assert of_the_systems_mathematics(path) <= EXACT
    numpy = Path(importlib.util.find_spec("numpy._core._multiarray_umath").origin)
    assert "cos" in of_the_systems_mathematics(numpy)  # the partner: another library of this machine


def test_the_library_exports_the_functions_of_fmi_and_nothing_else(library, fmu_path):
    names = exported(library)
    assert all(name.startswith("fmi2") for name in names)
    assert names == set(TABLE) | OTHER_FUNCTIONS  # 44 functions
    assert names != exported(fmu_path.parent / "libwheel_equations.so")


def test_the_library_has_no_executable_stack_no_late_relocations_in_code_and_no_path_of_this_machine(library):
    headers = lines_of("readelf", "--program-headers", "--wide", str(library))
    (stack,) = [line for line in headers if "GNU_STACK" in line]
    assert "RWE" not in stack
    assert not any("TEXTREL" in line for line in lines_of("readelf", "--dynamic", "--wide", str(library)))
    content = library.read_bytes()
    assert str(ROOT).encode() not in content and str(Path.home()).encode() + b"/" not in content
    assert b"fmi2DoStep" in content


def entries_of(path: Path) -> list[zipfile.ZipInfo]:
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
        return archive.infolist()


def test_the_archive_is_laid_out_as_the_standard_says(fmu_path):
    entries = entries_of(fmu_path)
    names = [entry.filename for entry in entries]
    assert len(names) == len(set(names)) and names == sorted(names)
    folders = {"binaries", "documentation", "extra", "licenses", "resources", "sources", "terminalsAndIcons"}
    top = {"modelDescription.xml", "model.png", *folders}
    assert {name.split("/")[0] for name in names} <= top
    assert {"modelDescription.xml", "model.png", "documentation/index.html", "licenses/license.txt"} <= set(names)
    for entry in entries:
        assert not entry.is_dir() and ".." not in entry.filename and "\\" not in entry.filename
        assert entry.filename.isascii() and not entry.filename.startswith("/")
        assert entry.compress_type == zipfile.ZIP_DEFLATED
        assert entry.external_attr >> 28 != 0xA  # no link
        assert entry.date_time == (1980, 1, 1, 0, 0, 0)
        assert entry.file_size > 0


def test_packing_the_same_content_gives_the_same_bytes(fmu_path, fmu, tmp_path):
    specification = importlib.util.spec_from_file_location("pack_fmu", ROOT / "cmake" / "pack_fmu.py")
    packer = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(packer)
    files = {p.relative_to(fmu).as_posix(): p for p in sorted(Path(fmu).rglob("*"), reverse=True) if p.is_file()}
    again, other = tmp_path / "again.fmu", tmp_path / "other.fmu"
    packer.pack(files, again)
    assert again.read_bytes() == fmu_path.read_bytes()
    changed = tmp_path / "LICENSE"
    changed.write_bytes(files["licenses/license.txt"].read_bytes() + b"\n")
    packer.pack(files | {"licenses/license.txt": changed}, other)
    assert other.read_bytes() != fmu_path.read_bytes()
