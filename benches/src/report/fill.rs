//! Wraps the paragraphs of rendered templates, because their numbers and names have any length.

/// Columns of a line of prose. `.ci/prose` checks the same width.
const WIDTH: usize = 100;

/// A Markdown text whose paragraphs and list items are filled up to [`WIDTH`] columns. Tables,
/// code, headings, rules, quotes and tags stay as they are.
pub(super) fn filled(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut block: Vec<&str> = Vec::new();
    let mut in_code = false;
    for line in text.split_inclusive('\n') {
        let is_fence = line.trim_start().starts_with("```");
        in_code ^= is_fence;
        let is_prose = !in_code && !is_fence && is_prose(line);
        if !is_prose || starts_item(&block, line) {
            flush(&mut block, &mut out);
        }
        if is_prose {
            block.push(line);
        } else {
            out.push_str(line);
        }
    }
    flush(&mut block, &mut out);
    out
}

/// Whether a line is the first one of a list item. A number with a point is one only at the start
/// of a list: inside a paragraph it ends a sentence.
fn starts_item(block: &[&str], line: &str) -> bool {
    let is_numbered = line.trim_start().starts_with(|c: char| c.is_ascii_digit());
    let is_in_list = block.first().is_none_or(|first| marker(first) > 0);
    marker(line) > 0 && (!is_numbered || is_in_list)
}

/// Whether a line outside of code is part of a paragraph that may be filled.
fn is_prose(line: &str) -> bool {
    let text = line.trim_end_matches('\n');
    let is_other = text.starts_with(['|', '#', '>', '<']) || text.starts_with("    ");
    let is_rule = text.trim_matches(['-', '=', ' ']).is_empty();
    // Two spaces at the end are a line break.
    !is_other && !is_rule && !text.ends_with("  ")
}

/// The width of a list item's marker with its space and indentation; 0 if a line has none.
fn marker(line: &str) -> usize {
    let text = line.trim_start_matches(' ');
    let indentation = line.len() - text.len();
    let number = text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let is_bullet = number == 0 && text.starts_with(['-', '*', '+']);
    let is_number = number > 0 && text[number..].starts_with('.');
    if (is_bullet || is_number) && text[number + 1..].starts_with(' ') {
        indentation + number + 2
    } else {
        0
    }
}

/// Whether a word would be read as a marker at the start of a line.
fn would_mark(word: &str) -> bool {
    word.starts_with(['#', '>', '<', '|', '=']) || marker(&format!("{word} ")) > 0
}

/// Writes the words of a paragraph or a list item, filled.
fn flush(block: &mut Vec<&str>, out: &mut String) {
    let lines = std::mem::take(block);
    let Some(first) = lines.first() else {
        return;
    };
    let own = first.len() - first.trim_start_matches(' ').len();
    let indentation = " ".repeat(marker(first).max(own));
    out.push_str(&first[..own]);
    let mut column = own;
    let mut words = lines.iter().flat_map(|line| line.split_ascii_whitespace()).peekable();
    let mut is_start = true;
    while let Some(word) = words.next() {
        // Words that would mark a line stay on that of the word before.
        let mut unit = word.to_owned();
        while let Some(next) = words.next_if(|next| !is_start && would_mark(next)) {
            unit.push(' ');
            unit.push_str(next);
        }
        let width = unit.chars().count();
        if !is_start && column + 1 + width > WIDTH {
            out.push('\n');
            out.push_str(&indentation);
            column = indentation.len();
        } else if !is_start {
            out.push(' ');
            column += 1;
        }
        out.push_str(&unit);
        column += width;
        is_start = false;
    }
    out.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A long paragraph and a long item, the latter under its text.
    #[test]
    fn paragraphs_are_filled() {
        let words = ["word"; 25].join(" ");
        let text = format!("{words} a - b\n\n- {words}\n  end\n- short\n");
        let [full, rest] = [["word"; 20].join(" "), ["word"; 5].join(" ")];
        let item = format!("- {}\n  word {rest} end\n", ["word"; 19].join(" "));
        assert_eq!(filled(&text), format!("{full}\n{rest} a - b\n\n{item}- short\n"));
    }

    /// A minus sign never starts a line, where it would be an item.
    #[test]
    fn signs_do_not_become_markers() {
        let words = ["word"; 20].join(" ");
        let text = format!("{words} - 1. > end\n");
        let kept = ["word"; 19].join(" ");
        assert_eq!(filled(&text), format!("{kept}\nword - 1. > end\n"));
    }

    #[test]
    fn sentences_may_end_in_numbers() {
        assert_eq!(filled("It takes\n12. Then\n1. it ends.\n"), "It takes 12. Then 1. it ends.\n");
        assert_eq!(filled("1. one\n2. two\n"), "1. one\n2. two\n");
    }

    #[test]
    fn other_lines_stay() {
        let long = ["word"; 25].join(" ");
        let text = format!("# {long}\n| {long} |\n> {long}\n<!-- {long} -->\n    {long}\n");
        assert_eq!(filled(&text), text);
        let code = format!("```text\n{long}\n```\n");
        assert_eq!(filled(&code), code);
        let rule = "short\nlines\n---\n\nbroken  \nlines\n";
        assert_eq!(filled(rule), "short lines\n---\n\nbroken  \nlines\n");
    }
}
