"""The code blocks of the documentation, compiled and run.

    blocks.py generate OUT.cpp LANGUAGE FILE.md...   one source with all C++ (or C) blocks
    blocks.py run PROGRAM LANGUAGE FILE.md...        runs those that have a main; compares what they print
    blocks.py python FILE.md...                      runs the Python blocks
    blocks.py cmake FOLDER PREFIX SOURCE FILE.md...  configures a project with each CMake block
    blocks.py programs FOLDER PREFIX FLAGS FILE.md...  builds every C++ and C program as its reader would,
                                                     alone in an empty folder, against what is installed

A block that has a main is run. One that is a fragment of a function's inside says above what it needs:

    <!-- within: signorini::lcp::SolverSettings settings; -->

and one whose output is documented says it behind (white space counts as one blank):

    <!-- prints: solved: z = 1 -->

A CMake block that is a whole CMakeLists.txt has <!-- whole --> above it. The first of them, and the first line
`cc my.c ...`, both of the first page, are how programs are built.
"""

import contextlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys

BLOCK = re.compile(
    r"(?:<!-- within: (?P<within>[^\n]*) -->\n)?(?P<whole><!-- whole -->\n)?"
    r"```(?P<language>[a-z]+)\n(?P<code>.*?)^```\n"
    r"(?:\n?<!-- prints: (?P<prints>[^\n]*) -->)?",
    re.DOTALL | re.MULTILINE,
)
MOST_LINES = 30  # of a first program
MAIN = re.compile(r"\bint main\((?:void)?\)")


def blocks(language, files):
    """(file, line, block) of every block in a language."""
    found = []
    for file in files:
        text = pathlib.Path(file).read_text(encoding="utf-8")
        for block in BLOCK.finditer(text):
            if block["language"] == language:
                line = text.count("\n", 0, block.start("code")) + 1
                found.append((file, line, block))
    return found


def normal(text):
    return " ".join(text.split())


def generate(out, language, files):
    """Includes first; each block a namespace of its own (C: names of its own); one main for all."""
    includes, bodies, cases = [], [], []
    for number, (file, line, block) in enumerate(blocks(language, files)):
        code = block["code"]
        includes += re.findall(r"^#include .*$", code, re.MULTILINE)
        code = re.sub(r"^#include .*$", "", code, flags=re.MULTILINE)
        where = f'#line {line} "{file}"\n'
        if language == "c":
            code = re.sub(r"\b(main|step)\(", rf"\1_{number}(", code)
            bodies.append(where + code)
            has_main = MAIN.search(block["code"]) is not None
            if has_main:
                cases.append(f"  if (number == {number}) return main_{number}();")
            continue
        if block["within"] is not None:
            includes += ["#include <signorini/lcp/io/dump_recorder.h>"] * ("Dump" in code)
            code = f"[[maybe_unused]] void fragment() {{\n{block['within']}\n{where}{code}}}\n"
        elif MAIN.search(code):
            code = where + MAIN.sub("int run()" if "return" in code else "void run()", code)
            cases.append(f"  if (number == {number}) {{ block_{number}::run(); return 0; }}")
        else:
            code = where + code
        bodies.append(f"namespace block_{number} {{\n{code}}}\n")
    lines = sorted(set(includes)) + ["#include <stdlib.h>", *bodies]
    lines += ["int main(int count, char** arguments) {",
              "  const int number = count > 1 ? atoi(arguments[1]) : -1;", *cases,
              "  return number == -1 ? 0 : 99;", "}", ""]
    pathlib.Path(out).write_text("\n".join(lines), encoding="utf-8")


def judge(file, line, expected, printed):
    if expected is not None and normal(expected) != normal(printed):
        sys.exit(f"{file}:{line}: documented: {normal(expected)}\n  printed: {normal(printed)}")
    print(f"{file}:{line}: {'prints what it says' if expected else 'runs'}")


def run(program, language, files):
    for number, (file, line, block) in enumerate(blocks(language, files)):
        if MAIN.search(block["code"]):
            done = subprocess.run([program, str(number)], capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{file}:{line}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
            judge(file, line, block["prints"], done.stdout)


def run_python(files):
    for file, line, block in blocks("python", files):
        code = compile("\n" * (line - 1) + block["code"], file, "exec")
        if block["within"] is not None:  # needs something that is not there: compiled alone
            continue
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(code, {"__name__": "__main__"})
        judge(file, line, block["prints"], printed.getvalue())


def configure(folder, prefix, source, files):
    for number, (file, line, block) in enumerate(blocks("cmake", files)):
        project = pathlib.Path(folder) / str(number)
        project.mkdir(parents=True, exist_ok=True)
        (project / "main.cpp").write_text("int main() {}\n", encoding="utf-8")
        head = "" if block["whole"] else (
            "cmake_minimum_required(VERSION 3.25)\nproject(engine LANGUAGES C CXX)\n"
            "add_executable(my_engine main.cpp)\n")
        (project / "CMakeLists.txt").write_text(head + block["code"], encoding="utf-8")
        subprocess.run(
            ["cmake", "-S", project, "-B", project / "build", f"-DCMAKE_PREFIX_PATH={prefix}",
             f"-DSIGNORINI_SOURCE={source}"], check=True, stdout=subprocess.DEVNULL)
        print(f"{file}:{line}: configures")


def build_by_cmake(folder, prefix, flags, code, lists):
    """With the documented CMakeLists.txt; its component is the one whose header the program includes."""
    part = re.search(r"#include <signorini/(?:integrations/)?(\w+)/", code)[1]
    (folder / "main.cpp").write_text(code, encoding="utf-8")
    (folder / "CMakeLists.txt").write_text(
        lists.replace("COMPONENTS lcp", f"COMPONENTS {part}").replace("::lcp", f"::{part}"),
        encoding="utf-8")
    options = [f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_FLAGS={flags}"]
    subprocess.run(["cmake", "-S", ".", "-B", "build", *options], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", "build"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return subprocess.run(["build/my_engine"], cwd=folder, capture_output=True, text=True)


def build_by_hand(folder, prefix, flags, code, line):
    """With the documented line for a shell."""
    (folder / "my.c").write_text(code, encoding="utf-8")
    if not list(pathlib.Path(prefix).rglob("libsignorini-c.a")):
        line = line.replace(" --static", "")
    places = ":".join(str(path) for path in pathlib.Path(prefix).rglob("pkgconfig"))
    return subprocess.run(line.replace("cc my.c", f"cc {flags} my.c"), shell=True, cwd=folder,
                          capture_output=True, text=True,
                          env={**os.environ, "PKG_CONFIG_PATH": places})


def programs(folder, prefix, flags, files):
    first_page = pathlib.Path(files[0]).read_text(encoding="utf-8")
    lists = next(block["code"] for _, _, block in blocks("cmake", files[:1]) if block["whole"])
    line = re.search(r"`(cc my\.c [^`]*)`", first_page)[1]
    for language, build, how in (("cpp", build_by_cmake, lists), ("c", build_by_hand, line)):
        found = [each for each in blocks(language, files) if MAIN.search(each[2]["code"])]
        if not found:
            sys.exit(f"no program in {language} on these pages")
        for number, (file, at, block) in enumerate(found):
            place = pathlib.Path(folder) / f"{language}-{number}"
            shutil.rmtree(place, ignore_errors=True)
            place.mkdir(parents=True)
            if block["code"].count("\n") > MOST_LINES:
                sys.exit(f"{file}:{at}: more than {MOST_LINES} lines")
            done = build(place, prefix, flags, block["code"], how)
            if done.returncode != 0:
                sys.exit(f"{file}:{at}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
            judge(file, at, block["prints"], done.stdout)


if __name__ == "__main__":
    command, arguments = sys.argv[1], sys.argv[2:]
    if command == "generate":
        generate(arguments[0], arguments[1], arguments[2:])
    elif command == "run":
        run(arguments[0], arguments[1], arguments[2:])
    elif command == "python":
        run_python(arguments)
    elif command == "programs":
        programs(arguments[0], arguments[1], arguments[2], arguments[3:])
    elif command == "cmake":
        configure(arguments[0], arguments[1], arguments[2], arguments[3:])
    else:
        sys.exit(__doc__)
