"""The library and the archive as files: what they need, export, contain and carry of licences."""

import importlib.util
import subprocess
import zipfile
from pathlib import Path

import fmpy
import pytest
from contract.call_states import TABLE

from wheelfmu.fmu import pack_fmu
from wheelfmu.fmu.paths import ROOT

pytestmark = pytest.mark.local
# Beside those of the table of call states.
OTHER_FUNCTIONS = {"fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2Instantiate", "fmi2FreeInstance"}
LIBRARIES = {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
HEADERS = Path(fmpy.__file__).parent / "c-code"


@pytest.fixture(scope="module")
def library(fmu: str) -> Path:
    (path,) = Path(fmu).glob("binaries/*linux*/wheel.so")
    return path


def lines_of(*command: str | Path) -> list[str]:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()


def dynamic(library: Path) -> list[str]:
    return lines_of("readelf", "--dynamic", "--wide", library)


def needed(library: Path) -> set[str]:
    return {line.split("[")[1].rstrip("]") for line in dynamic(library) if "(NEEDED)" in line}


def names(library: Path, which: str) -> set[str]:
    symbols = lines_of("nm", "--dynamic", f"--{which}-only", library)
    return {line.split()[-1].split("@")[0] for line in symbols} - {"wheel_1", "WHEEL"}


def of_numpy(module: str) -> Path:
    """A library of this machine: the partner."""
    return Path(importlib.util.find_spec(f"numpy.{module}").origin)


def test_the_library_needs_libc_and_libm_only(library):
    assert needed(library) <= LIBRARIES
    assert not needed(of_numpy("linalg._umath_linalg")) <= LIBRARIES


# Rounded correctly in every libm, as IEEE 754 asks, and cosines are not.
EXACT = {"fabs", "floor", "ceil", "fmax", "fmin", "fmod", "nearbyint", "remainder", "scalbn", "sqrt"}


def of_the_systems_mathematics(library: Path) -> set[str]:
    """What a library takes from libm; perhaps nothing, since some compilers compute a remainder themselves."""
    libms = [line.split()[2] for line in lines_of("ldd", library) if line.split()[0].startswith("libm.")]
    return {name for libm in libms for name in names(library, "undefined") & names(Path(libm), "defined")}


def test_of_the_systems_mathematics_the_libraries_take_only_what_is_exact(library, fmu_path):
    for path in (library, fmu_path.parent / "libwheel_equations.so"):
        assert of_the_systems_mathematics(path) <= EXACT
    assert "cos" in of_the_systems_mathematics(of_numpy("_core._multiarray_umath"))


def test_the_library_exports_the_functions_of_fmi_and_nothing_else(library, fmu_path):
    assert names(library, "defined") == set(TABLE) | OTHER_FUNCTIONS  # 44 functions
    assert names(library, "defined") != names(fmu_path.parent / "libwheel_equations.so", "defined")


def test_the_library_has_no_executable_stack_no_late_relocations_in_code_and_no_path_of_this_machine(library):
    headers = lines_of("readelf", "--program-headers", "--wide", library)
    (stack,) = [line for line in headers if "GNU_STACK" in line]
    assert "RWE" not in stack and not any("TEXTREL" in line for line in dynamic(library))
    content = library.read_bytes()
    assert str(ROOT).encode() not in content and str(Path.home()).encode() + b"/" not in content
    assert b"fmi2DoStep" in content


START_UP = 16  # bytes: the handle and the flag of the compiler's start-up code, a word each


def shared_memory(library: Path) -> int:
    """Bytes that all instances can write to."""
    lines = [line.split("]")[-1].split() for line in lines_of("readelf", "--sections", "--wide", library)]
    return sum(int(line[4], 16) for line in lines if line[:1] in ([".data"], [".bss"]))


def test_the_library_shares_no_memory_between_instances(library):
    """So there is no list of them, and no lock."""
    assert shared_memory(library) <= START_UP < shared_memory(of_numpy("linalg._umath_linalg"))


def test_the_archive_is_laid_out_as_the_standard_says(fmu_path):
    with zipfile.ZipFile(fmu_path) as archive:
        assert archive.testzip() is None
        entries = archive.infolist()
    names = [entry.filename for entry in entries]
    assert len(names) == len(set(names)) and names == sorted(names)
    folders = {"binaries", "documentation", "extra", "licenses", "resources", "sources", "terminalsAndIcons"}
    assert {name.split("/")[0] for name in names} <= {"modelDescription.xml", "model.png", *folders}
    assert {"modelDescription.xml", "model.png", "documentation/index.html", "licenses/license.txt"} <= set(names)
    for entry in entries:
        assert not entry.is_dir() and ".." not in entry.filename and entry.filename.isascii()
        assert (entry.compress_type, entry.date_time) == (zipfile.ZIP_DEFLATED, (1980, 1, 1, 0, 0, 0))
        assert entry.external_attr >> 28 != 0xA and entry.file_size > 0  # no link


def test_packing_the_same_content_gives_the_same_bytes(fmu_path, fmu, tmp_path):
    files = {p.relative_to(fmu).as_posix(): p for p in sorted(Path(fmu).rglob("*"), reverse=True) if p.is_file()}
    again, other = tmp_path / "again.fmu", tmp_path / "other.fmu"
    pack_fmu.pack(files, again)
    pack_fmu.pack(files | {"licenses/license.txt": b"another"}, other)
    assert again.read_bytes() == fmu_path.read_bytes() != other.read_bytes()


IN_LICENCE = {
    "license.txt": "wheel.fmu founders",
    "sundials-license.txt": "Lawrence Livermore",
    "eigen-license.txt": "Exhibit A - Source Code Form License Notice",  # its last section
    "eigen-notice.txt": "Mozilla Public",
    "fmi-headers-notice.txt": "EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE",  # its last words
}


def contains(text: str, piece: str) -> bool:
    return " ".join(piece.split()) in " ".join(text.split())


def test_the_archive_carries_the_licences_word_for_word(fmu):
    texts = {name: (Path(fmu) / "licenses" / name).read_text(encoding="utf-8") for name in IN_LICENCE}
    assert all(contains(texts[name], piece) for name, piece in IN_LICENCE.items())
    notice = texts["fmi-headers-notice.txt"]
    for header in ("fmi2Functions.h", "fmi2FunctionTypes.h", "fmi2TypesPlatform.h"):
        text = (HEADERS / header).read_text(encoding="utf-8")
        assert contains(text, notice) and not contains(text, notice.replace("must reproduce", "should reproduce"))
