"""Makes the wheel. usage: python3 build.py SOURCE BUILD VERSION PROTO_DIR PROTOC GRPC_PLUGIN

SOURCE is this folder. BUILD gets package/ (sources and generated code), dist/ (the wheel) and
installed/ (the wheel's contents).
"""

import os
import pathlib
import shutil
import subprocess
import sys
import zipfile

import setuptools.build_meta


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
    with zipfile.ZipFile(dist / wheel) as file:
        file.extractall(pathlib.Path(build) / "installed")


if __name__ == "__main__":
    main()
