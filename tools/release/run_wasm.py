"""Runs a WebAssembly program of WASI in wasmtime, as a command of its own: run_wasm.py PROGRAM ARGUMENT..."""

from __future__ import annotations

import sys

import wasmtime


def main() -> int:
    engine = wasmtime.Engine()
    linker = wasmtime.Linker(engine)
    linker.define_wasi()
    configuration = wasmtime.WasiConfig()
    configuration.argv = sys.argv[1:]
    configuration.inherit_stdout()
    configuration.inherit_stderr()
    store = wasmtime.Store(engine)
    store.set_wasi(configuration)
    program = linker.instantiate(store, wasmtime.Module.from_file(engine, sys.argv[1]))
    try:
        program.exports(store)["_start"](store)
    except wasmtime.ExitTrap as ended:
        return ended.code
    return 0


if __name__ == "__main__":
    sys.exit(main())
