"""Hook of mkdocs.yml: the site holds the documents, the files and folders that they link to, and
pages that are made from the API's files and the programs' help."""
import atexit
import os
import re
import shutil
import subprocess
import tempfile

from mkdocs.structure.files import File, Files

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PAGES = re.compile(r"(README|CONTRIBUTING|SECURITY|CHANGELOG)\.md$|docs/")
LINK = re.compile(r"\]\(([^)#:]+)[^)]*\)")


def _read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def _linked(page):
    """Paths of the project that a page names."""
    for target in LINK.findall(_read(os.path.join(ROOT, page))):
        yield os.path.normpath(os.path.join(os.path.dirname(page), target))


def _messages():
    text = "# API messages\n\nThe files of `proto/homing/v1/`, whose comments are the reference.\n"
    folder = os.path.join(ROOT, "proto/homing/v1")
    for name in sorted(os.listdir(folder)):
        text += f"\n## {name}\n\n```protobuf\n{_read(os.path.join(folder, name))}```\n"
    return text


def _help(*command):
    return subprocess.run([*command, "--help"], capture_output=True, text=True, check=True,
                          env={**os.environ, "COLUMNS": "100"}).stdout


def _commands():
    build = os.environ.get("HOMING_BUILD", os.path.join(ROOT, "build/dev"))
    text = "# Commands and flags\n"
    for program in ("server/homing-server", "client/homing"):
        name = os.path.basename(program)
        path = os.path.join(build, program)
        if not os.access(path, os.X_OK):
            text += f"\n## {name}\n\nRun `{name} --help`.\n"
            continue
        whole = _help(path)
        text += f"\n## {name}\n\n```text\n{whole}```\n"
        for command in re.findall(r"^  ([a-z]+)\s", whole.partition("Subcommands:")[2], re.M):
            text += f"\n### {name} {command}\n\n```text\n{_help(path, command)}```\n"
    return text.replace(build + "/", "")


def on_files(files, config):
    tracked = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT,
                             capture_output=True, text=True, check=True).stdout.splitlines()
    pages = [path for path in tracked if PAGES.match(path)]
    linked = {path for page in pages if page.endswith(".md") for path in _linked(page)}
    made = {"docs/api-messages.md": _messages(), "docs/commands.md": _commands()}
    for folder in linked:
        inside = [path for path in tracked if os.path.dirname(path) == folder]
        if inside and folder + "/README.md" not in tracked:
            linked = linked | set(inside)
            made[folder + "/README.md"] = f"# {folder}\n\n" + "".join(
                f"- [{name}]({name})\n" for name in map(os.path.basename, inside))
    scratch = tempfile.mkdtemp(prefix="homing-site.")
    atexit.register(shutil.rmtree, scratch)
    for path, text in made.items():
        os.makedirs(os.path.join(scratch, os.path.dirname(path)), exist_ok=True)
        with open(os.path.join(scratch, path), "w", encoding="utf-8") as file:
            file.write(text)
    add = [(path, ROOT) for path in sorted(set(pages) | (linked & set(tracked)))]
    add += [(path, scratch) for path in sorted(made)]
    theme = [file for file in files if not file.abs_src_path.startswith(config["docs_dir"])]
    return Files(theme + [File(path, source, config["site_dir"], config["use_directory_urls"])
                          for path, source in add])
