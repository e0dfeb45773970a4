# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The page that leads to the reference of the public headers, which Doxygen writes."""
from xml.etree import ElementTree

HEAD = """# C++ reference

Reference of the public headers by Doxygen: [classes and structs](../api/annotated.html), [files](../api/files.html),
[members by name](../api/functions.html), [functions and constants of namespaces](../api/namespacemembers.html).
[Install](../docs/install.md#c-library) says how to link the library and has an example. Start at
[`viscera::Session`](../api/{session}).

The tables list the headers, and the classes and structs in each.
"""


def page(root, api):
    """Returns the page. api: the folder of Doxygen's pages and of its index viscera.tag, which is rewritten without the
    path of the root: Doxygen has no setting for it."""
    index = api / 'viscera.tag'
    text = index.read_text(encoding='utf-8')
    for folder in ('include', 'docs/site'):
        text = text.replace(f'{root}/{folder}/', '')
    index.write_text(text, encoding='utf-8')
    compounds = ElementTree.parse(index).getroot().findall('compound')
    places = {each.findtext('name'): each.findtext('filename') for each in compounds if each.get('kind') in {'class', 'struct'}}
    folders = {}
    for each in compounds:
        if each.get('kind') == 'file' and each.findtext('name').endswith('.h'):
            folders.setdefault(each.findtext('path').rstrip('/'), []).append(each)
    out = [HEAD.format(session=places['viscera::Session'])]
    for folder, headers in sorted(folders.items()):
        out += [f'## {folder}', '', '| header | classes and structs |', '|---|---|']
        for header in sorted(headers, key=lambda each: each.findtext('name')):
            types = [name.text for name in header.findall('class') if name.text in places]
            shown = ', '.join(f'[`{name.removeprefix("viscera::")}`](../api/{places[name]})' for name in types)
            out.append(f'| [`{header.findtext("name")}`](../api/{header.findtext("filename")}) | {shown} |')
        out.append('')
    return '\n'.join(out)
