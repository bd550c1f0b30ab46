"""What rules ask of a document: its links and joints, elements by tag, numbers, values before xacro."""
