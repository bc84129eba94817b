//! Refuses hostile XML before a tree is built from it: too large, too deep, with entities.

use super::desk::Desk;

/// The largest document that is read, bytes. A caller that reads a file looks at its length first.
pub const LARGEST_DOCUMENT: usize = 4 << 20;
/// The most levels of elements.
pub const DEEPEST_ELEMENT: usize = 16;
/// The most elements, texts and comments.
pub const MOST_NODES: u32 = 100_000;

/// Looks through the text once, in constant memory; tells what it refuses.
pub(super) fn admit(desk: &mut Desk) -> bool {
    let source = desk.source.clone();
    let text = source.text.as_str();
    if text.len() > LARGEST_DOCUMENT {
        let message = format!("the document has {} bytes; at most {LARGEST_DOCUMENT} are read", text.len());
        // The place would carry the whole text into the message: there is none.
        desk.lost(message, "equations need far less: keep data in files of their own");
        return false;
    }
    let (mut position, mut depth) = (0, 0usize);
    while let Some(found) = text[position..].find('<') {
        let start = position + found;
        let rest = &text[start..];
        let past = |end: &str| rest.find(end).map_or(text.len(), |at| start + at + end.len());
        position = if rest.starts_with("<!--") {
            past("-->")
        } else if rest.starts_with("<![CDATA[") {
            past("]]>")
        } else if rest.starts_with("<?") {
            past("?>")
        } else if rest.starts_with("<!") {
            let message = "a document type and entities of its own are not read";
            desk.fault(start..start + 2, message, "begins here", "remove the <!DOCTYPE …>; EML needs none");
            return false;
        } else {
            let end = tag_end(rest);
            if rest.starts_with("</") {
                depth = depth.saturating_sub(1);
            } else if !rest[..end].ends_with("/>") {
                depth += 1;
            }
            start + end
        };
        if depth > DEEPEST_ELEMENT {
            let message = format!("elements are nested more than {DEEPEST_ELEMENT} deep");
            desk.fault(start..start + 1, &message, "too deep", "EML has three levels; close elements with </…> or />");
            return false;
        }
    }
    true
}

/// Bytes of a tag, with its angle brackets; quoted values may hold `>`.
pub(super) fn tag_end(tag: &str) -> usize {
    let mut quote = None;
    for (at, byte) in tag.bytes().enumerate() {
        match quote {
            Some(open) if open == byte => quote = None,
            Some(_) => {}
            None if byte == b'"' || byte == b'\'' => quote = Some(byte),
            None if byte == b'>' => return at + 1,
            None => {}
        }
    }
    tag.len()
}
