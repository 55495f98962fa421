"""Makes the wheel. usage: python3 build.py SOURCE BUILD VERSION PROTO_DIR PROTOC GRPC_PLUGIN

SOURCE is this folder. BUILD gets package/ (sources and generated code), dist/ (the wheel) and
installed/ (the wheel's contents) and homing-vda5050.1.gz (its man page, from --help).
"""

import gzip
import importlib
import os
import pathlib
import shutil
import subprocess
import sys
import zipfile

import setuptools.build_meta


def man_page(parser, version: str) -> str:
    def escaped(text: str) -> str:
        return text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")

    summary = parser.description.splitlines()[0].rstrip(".")
    lines = [("\\&" if line.startswith(".") else "") + escaped(line)
             for line in parser.format_help().splitlines()]
    return "\n".join([f'.TH {parser.prog.upper()} 1 "" "homing {version}" "User Commands"',
                      ".SH NAME", f"{escaped(parser.prog)} \\- {escaped(summary[0].lower() + summary[1:])}",
                      ".SH DESCRIPTION", ".nf", *lines, ".fi", ".SH SEE ALSO", "homing(1)", ""])


def main() -> None:
    source, build, version, protos, protoc, plugin = sys.argv[1:]
    package = pathlib.Path(build) / "package"
    shutil.rmtree(build, ignore_errors=True)
    shutil.copytree(pathlib.Path(source) / "homing", package / "homing",
                    ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(pathlib.Path(source) / "pyproject.toml", package)
    (package / "VERSION").write_text(version + "\n")
    names = ["types", "journey_service", "homing_service", "deviation_model_service"]
    subprocess.run([protoc, f"-I{protos}", f"--python_out={package}", f"--pyi_out={package}",
                    f"--grpc_out={package}", f"--plugin=protoc-gen-grpc={plugin}"] +
                   [f"homing/v1/{name}.proto" for name in names], check=True)
    (package / "homing" / "v1" / "types_pb2_grpc.py").unlink(missing_ok=True)
    (package / "homing" / "v1" / "__init__.py").write_text(
        '"""The messages and stubs of package homing.v1, generated."""\n')
    dist = pathlib.Path(build) / "dist"
    dist.mkdir()
    os.environ.setdefault("SOURCE_DATE_EPOCH", "315532800")
    os.chdir(package)
    wheel = setuptools.build_meta.build_wheel(os.path.relpath(dist, package))
    installed = pathlib.Path(build) / "installed"
    with zipfile.ZipFile(dist / wheel) as file:
        file.extractall(installed)
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(installed))
    os.environ["COLUMNS"] = "90"
    parser = importlib.import_module("homing.vda5050").make_parser()
    page = gzip.compress(man_page(parser, version).encode(), mtime=0)
    (pathlib.Path(build) / "homing-vda5050.1.gz").write_bytes(page)


if __name__ == "__main__":
    main()
