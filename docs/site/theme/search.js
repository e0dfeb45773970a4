// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Search in the index of MkDocs, which search_index.js sets as kIndex. Works without a server and without a network.
'use strict';

const kMost = 40;  // results that are shown
const kAround = 90;  // characters of the text before and after what was found

/** Returns the sections that contain all words, best first: words in the title count more than words in the text. */
function search(words) {
  const found = [];
  for (const doc of kIndex.docs) {
    if (!doc.location.includes('#')) continue;  // a whole page: its sections follow
    const title = doc.title.toLowerCase(), text = doc.text.toLowerCase();
    let score = 0;
    for (const word of words) {
      const inTitle = title.includes(word) ? (title.split(/\W+/).includes(word) ? 30 : 15) : 0;
      const inText = Math.min(text.split(word).length - 1, 8);
      if (!inTitle && !inText) {
        score = 0;
        break;
      }
      score += inTitle + inText;
    }
    if (score && title === words.join(' ')) score += 60;
    if (score) found.push({doc, score});
  }
  return found.sort((a, b) => b.score - a.score).map(each => each.doc);
}

function element(name, text) {
  const out = document.createElement(name);
  out.textContent = text;
  return out;
}

function excerpt(text, word) {
  const at = Math.max(text.toLowerCase().indexOf(word), 0);
  const begin = Math.max(at - kAround, 0), end = at + kAround;
  return (begin ? '... ' : '') + text.slice(begin, end) + (end < text.length ? ' ...' : '');
}

/** Shows the results for a text in place of the page; the page again if it is empty. */
function show(typed) {
  const results = document.getElementById('results'), words = typed.toLowerCase().split(/\s+/).filter(Boolean);
  results.hidden = !words.length;
  document.getElementById('content').hidden = !results.hidden;
  if (!words.length) return;
  const docs = search(words), list = document.createElement('ul');
  for (const doc of docs.slice(0, kMost)) {
    const item = document.createElement('li'), link = element('a', doc.title || doc.location);
    link.href = kBase + '/' + doc.location;
    link.addEventListener('click', () => show(''));
    item.append(link, ' ', element('code', doc.location.split('#')[0]), element('p', excerpt(doc.text, words[0])));
    list.append(item);
  }
  const count = docs.length > kMost ? `${docs.length} sections, the first ${kMost}` : `${docs.length} section${docs.length === 1 ? '' : 's'}`;
  results.replaceChildren(element('h1', `Search: ${typed.trim()}`), element('p', count), list);
}

const box = document.getElementById('search');
box.addEventListener('input', () => show(box.value));
document.addEventListener('keydown', event => {
  if (event.key === '/' && document.activeElement !== box) {
    event.preventDefault();
    box.focus();
  } else if (event.key === 'Escape') {
    box.value = '';
    show('');
  }
});
show(box.value = new URLSearchParams(location.search).get('q') || '');
