# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The reference of the Python package, without importing it: signatures from the stubs and sources in
src/python/viscera, texts from docstrings and, for the compiled part, from the strings of src/python/*.cpp."""
import ast
import re
import textwrap

HEAD = """# Python reference

Classes and functions of the package `viscera`. [Python](../docs/python.md) has examples, and tables of tasks,
observations and rewards.

"""
STRINGS = re.compile(r'((?:"(?:\\.|[^"\\])*"\s*)+)\)$')


def statement(text, begin):
    """Returns the call that begins in C++ text at a place, up to its closing parenthesis."""
    depth, at = 0, text.index('(', begin)
    while True:
        if text[at] == '"':
            at = re.compile(r'"(?:\\.|[^"\\])*"').match(text, at).end()
            continue
        if text[at] == "'":
            at = re.compile(r"'(?:\\.|[^'\\])*'").match(text, at).end()
            continue
        depth += {'(': 1, ')': -1}.get(text[at], 0)
        at += 1
        if depth == 0:
            return text[begin:at]


def last_string(call):
    """Returns the last argument of a call if it is a string and not the only one; else nothing."""
    found = STRINGS.search(call)
    if not found or not call[:found.start()].rstrip().endswith(','):
        return ''
    return ''.join(ast.literal_eval(part) for part in re.findall(r'"(?:\\.|[^"\\])*"', found[1]))


def compiled_texts(folder):
    """Returns {"Class" or "Class.member": text} of the classes that pybind11 binds in the sources of a folder."""
    out = {}
    for source in sorted(folder.glob('*.cpp')):
        text = source.read_text(encoding='utf-8')
        text = re.sub(r'//.*', '', text)
        classes = {}
        for found in re.finditer(r'(?:auto (\w+) = py::class_<[^;]*?>|\w*Class (\w+))\(\s*module, "(\w+)"', text):
            classes[found[1] or found[2]] = found[3]
            call = statement(text, text.rindex('(', 0, found.start(3)))
            out[found[3]] = last_string(call)
        for found in re.finditer(r'\b(\w+)\.def(?:_\w+)?\(\s*(?:"(\w+)"|(py::init))', text):
            if found[1] in classes:
                name = f'{classes[found[1]]}.{found[2] or "__init__"}'
                out[name] = last_string(statement(text, found.start()))
    return out


def signature(node, name):
    """Returns the arguments of a function as its users write them, and what it returns."""
    arguments = ast.unparse(node.args)
    arguments = re.sub(r'^(self|cls)(, )?', '', arguments).replace("'PathLike[str]'", 'PathLike[str]')
    returns = f' -> {ast.unparse(node.returns)}' if node.returns and name != '__init__' else ''
    returns = re.sub(r"'(\w+)'", r'\1', returns)
    return arguments, returns


def call(node, name, function):
    """Returns a line of code for the call of a function, or several if it is long."""
    arguments, returns = signature(node, function)
    if len(name) + len(arguments) + len(returns) < 80:
        return [f'    {name}({arguments}){returns}']
    parts, begin, depth = [], 0, 0
    for at, letter in enumerate(arguments):
        depth += {'(': 1, '[': 1, ')': -1, ']': -1}.get(letter, 0)
        if letter == ',' and depth == 0:
            parts.append(arguments[begin:at + 1])
            begin = at + 2
    lines = [f'        {part}' for part in [*parts, arguments[begin:]]]
    return [f'    {name}(', *lines[:-1], f'{lines[-1]}){returns}']


def plain(text):
    """Returns a docstring as paragraphs and code; HTML in it is text."""
    lines = textwrap.dedent('    ' + text if '\n' in text else text).strip().split('\n')
    body = [lines[0], *textwrap.dedent('\n'.join(lines[1:])).split('\n')] if len(lines) > 1 else lines
    out = []
    for line in body:
        if re.match(r'\w+  +\S', line):  # a name and its meaning, in columns
            line = re.sub(r'^(\w+)  +', r'* `\1`: ', line)
            if out and out[-1].strip() and not out[-1].startswith('* '):
                out.append('')
        elif out and out[-1].startswith('* ') and line.strip() and not line.startswith(' '):
            out.append('')
        out.append(line if line.startswith('    ') else re.sub(r'([*_<>\[\]|])', r'\\\1', line) if not line.startswith('* `') else line)
    return '\n'.join(out)


def short(text):
    """Returns a text as a cell of a table."""
    return re.sub(r'([*_<>\[\]|])', r'\\\1', ' '.join(text.split()))


def class_section(node, module, texts, hidden=()):
    """Returns the lines of a class: its text, constructor, methods, and a table of its properties.
    hidden: classes that are no part of the interface; their members are listed with the classes that derive from them."""
    bases = [ast.unparse(base) for base in node.bases if ast.unparse(base) not in hidden]
    for base in node.bases:
        for name in [key for key in texts if key.startswith(ast.unparse(base) + '.') and ast.unparse(base) in hidden]:
            texts.setdefault(f'{node.name}.{name.split(".")[1]}', texts[name])
    inherited = [each for base in node.bases if ast.unparse(base) in hidden for each in hidden[ast.unparse(base)].body]
    out = [f'### {node.name}', '']
    members = [each for each in node.body if isinstance(each, ast.FunctionDef)]
    made = next((each for each in members if each.name == '__init__'), None)
    if made:
        out += [*call(made, f'{module}.{node.name}', '__init__'), '']
    if bases:
        out += ['Derived from ' + ', '.join(f'`{base}`' for base in bases) + '.', '']
    about = ast.get_docstring(node) or texts.get(node.name, '')
    if not about:
        raise ValueError(f'{module}.{node.name}: neither a docstring nor a text where src/python/*.cpp binds it')
    out += [plain(about), '']
    if made and (ast.get_docstring(made) or texts.get(f'{node.name}.__init__')):
        out += [plain(ast.get_docstring(made) or texts[f'{node.name}.__init__']), '']
    properties, methods = [], []
    for each in inherited + node.body:
        if isinstance(each, ast.AnnAssign):
            properties.append((each.target.id, ast.unparse(each.annotation), texts.get(f'{node.name}.{each.target.id}', '')))
        elif isinstance(each, ast.FunctionDef) and any(ast.unparse(mark) == 'property' for mark in each.decorator_list):
            text = ast.get_docstring(each) or texts.get(f'{node.name}.{each.name}', '')
            properties.append((each.name, ast.unparse(each.returns) if each.returns else '', text))
        elif isinstance(each, ast.FunctionDef) and (not each.name.startswith('_') or each.name in {'__len__', '__getitem__'}):
            methods.append(each)
    if methods:
        out += ['| method | meaning |', '|---|---|']
        for each in methods:
            arguments, returns = signature(each, each.name)
            text = ast.get_docstring(each) or texts.get(f'{node.name}.{each.name}', '')
            code = f'{each.name}({arguments}){returns}'
            out.append(f'| `{code}` | {short(text)} |')
        out.append('')
    if properties:
        out += ['| property | type | meaning |', '|---|---|---|']
        out += [f'| `{name}` | {f"`{kind}`" if kind else ""} | {short(text)} |' for name, kind, text in properties]
        out.append('')
    return out


def function_section(node, module):
    return [f'### {node.name}', '', *call(node, f'{module}.{node.name}', node.name), '', plain(ast.get_docstring(node) or ''), '']


def exported(tree):
    """Returns the names in __all__ of a module."""
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == '__all__':
            return ast.literal_eval(node.value)
    return []


def page(root):
    """Returns the page."""
    folder = root / 'src' / 'python'
    texts, out = compiled_texts(folder), [HEAD]
    sources = {path: ast.parse(path.read_text(encoding='utf-8')) for path in sorted((folder / 'viscera').rglob('*.py'))}
    for path, tree in sources.items():
        if path.parent == folder / 'viscera':
            texts.update({node.name: ast.get_docstring(node) for node in tree.body
                          if isinstance(node, ast.ClassDef) and ast.get_docstring(node)})
    for stub in sorted((folder / 'viscera').rglob('*.pyi')):
        module = '.'.join(stub.parent.relative_to(folder).parts)
        about = ast.get_docstring(sources[stub.with_suffix('.py')]) or ''
        out += [f'## {module}', '', plain(about), '']
        first, errors, public = len(out), [], exported(sources[stub.with_suffix('.py')])
        nodes = ast.parse(stub.read_text(encoding='utf-8')).body
        hidden = {node.name: node for node in nodes if isinstance(node, ast.ClassDef) and node.name not in public}
        for node in nodes:
            if getattr(node, 'name', '') in hidden:
                continue
            if isinstance(node, ast.ClassDef) and node.bases and ast.unparse(node.bases[0]) in {'RuntimeError', 'Error'}:
                errors.append(f'| `{node.name}` | `{ast.unparse(node.bases[0])}` |')
            elif isinstance(node, ast.ClassDef):
                out += class_section(node, module, texts, hidden)
            elif isinstance(node, ast.FunctionDef):
                out += function_section(node, module)
        for node in nodes:  # signatures name the public class
            for base in getattr(node, 'bases', ()):
                if ast.unparse(base) in hidden:
                    out[first:] = [re.sub(rf'\b{ast.unparse(base)}\b', node.name, line) for line in out[first:]]
        if errors:
            out += ['### Errors', '', '| exception | derived from |', '|---|---|', *errors, '']
    for init in sorted((folder / 'viscera').rglob('__init__.py')):
        if init.with_suffix('.pyi').exists():
            continue
        module = '.'.join(init.parent.relative_to(folder).parts)
        out += [f'## {module}', '', plain(ast.get_docstring(sources[init]) or ''), '']
        nodes = {node.name: node for path, tree in sources.items() if path.parent == init.parent for node in tree.body
                 if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        for name in exported(sources[init]):
            if isinstance(nodes.get(name), ast.ClassDef):
                out += class_section(nodes[name], module, {})
            elif name in nodes:
                out += function_section(nodes[name], module)
    return '\n'.join(out)
