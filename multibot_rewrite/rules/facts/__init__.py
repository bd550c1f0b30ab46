"""What rules read of a document: links and joints, elements by tag, numbers, values before xacro."""
