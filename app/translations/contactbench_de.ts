<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de_DE">
<context>
    <name>AboutDialog</name>
    <message>
        <source>see the package&apos;s own files</source>
        <translation>siehe Dateien des Pakets</translation>
    </message>
    <message>
        <source>About contactbench</source>
        <translation>Über contactbench</translation>
    </message>
    <message>
        <source>contactbench {}</source>
        <translation>contactbench {}</translation>
    </message>
    <message>
        <source>Locates contacts on a probe from a single force/torque sensor and states how certain each one is. Licensed under the Apache License 2.0. For bench work and research only: not a medical device.</source>
        <translation>Findet mit einem einzigen Kraft-Momenten-Sensor, wo eine Sonde berührt wird, und gibt an, wie sicher das ist. Lizenziert unter der Apache License 2.0. Nur für Labor und Forschung: kein Medizinprodukt.</translation>
    </message>
    <message>
        <source>Component licences</source>
        <translation>Lizenzen der Bestandteile</translation>
    </message>
    <message>
        <source>Components and their licences:</source>
        <translation>Bestandteile und ihre Lizenzen:</translation>
    </message>
</context>
<context>
    <name>ActionBar</name>
    <message>
        <source>What to do next</source>
        <translation>Was als Nächstes zu tun ist</translation>
    </message>
    <message>
        <source>Message</source>
        <translation>Meldung</translation>
    </message>
</context>
<context>
    <name>AlignmentPanel</name>
    <message>
        <source>Enter numbers</source>
        <translation>Zahlen eingeben</translation>
    </message>
    <message>
        <source>Match points</source>
        <translation>Punktpaare zuordnen</translation>
    </message>
    <message>
        <source>Mounting face</source>
        <translation>Montagefläche</translation>
    </message>
    <message>
        <source>Touch marked points</source>
        <translation>Markierte Punkte berühren</translation>
    </message>
    <message>
        <source>Estimate from shape</source>
        <translation>Aus der Form schätzen</translation>
    </message>
    <message>
        <source>Load from file</source>
        <translation>Aus Datei laden</translation>
    </message>
    <message>
        <source>Alignment method</source>
        <translation>Ausrichtungsmethode</translation>
    </message>
    <message>
        <source>Rotation about the sensor&apos;s fixed {} axis, degrees; applied in the order x, y, z</source>
        <translation>Drehung um die feste {}-Achse des Sensors, Grad; in der Reihenfolge x, y, z</translation>
    </message>
    <message>
        <source>Mesh origin along sensor {}, mm</source>
        <translation>Ursprung des Netzes entlang {} des Sensors, mm</translation>
    </message>
    <message>
        <source>Apply placement</source>
        <translation>Lage anwenden</translation>
    </message>
    <message>
        <source>Click a point on the mesh, then enter its position in the sensor frame. Use three widely spaced points; a fourth reveals errors.</source>
        <translation>Klicken Sie einen Punkt auf dem Netz an und geben Sie seine Lage im Sensorsystem ein. Nehmen Sie drei weit auseinanderliegende Punkte; ein vierter deckt Fehler auf.</translation>
    </message>
    <message>
        <source>Align to these points</source>
        <translation>An diesen Punkten ausrichten</translation>
    </message>
    <message>
        <source>Angle of the second point about +z, from the sensor&apos;s +x, degrees</source>
        <translation>Winkel des zweiten Punkts um +z, von +x des Sensors aus, Grad</translation>
    </message>
    <message>
        <source>Second point at</source>
        <translation>Zweiter Punkt bei</translation>
    </message>
    <message>
        <source>Height of the mounting plane above the sensor origin, mm</source>
        <translation>Höhe der Montagefläche über dem Sensorursprung, mm</translation>
    </message>
    <message>
        <source>Face height</source>
        <translation>Höhe der Fläche</translation>
    </message>
    <message>
        <source>Align this face</source>
        <translation>Diese Fläche ausrichten</translation>
    </message>
    <message>
        <source>Pick again</source>
        <translation>Neu wählen</translation>
    </message>
    <message>
        <source>Touch marked points on the probe, then choose the table: px, py, pz in the mesh frame in mm, and fx to mz in the sensor frame. The search starts from the placement above.</source>
        <translation>Berühren Sie markierte Punkte der Sonde und wählen Sie dann die Tabelle: px, py, pz im Netzsystem in mm und fx bis mz im Sensorsystem. Die Suche beginnt bei der oben angegebenen Lage.</translation>
    </message>
    <message>
        <source>Choose touches…</source>
        <translation>Berührungen wählen…</translation>
    </message>
    <message>
        <source>Touches</source>
        <translation>Berührungen</translation>
    </message>
    <message>
        <source>Position of the mesh in the sensor frame, and rotation about its axes:</source>
        <translation>Lage des Netzes im Sensorsystem, und Drehung um dessen Achsen:</translation>
    </message>
    <message>
        <source>Tables (*.csv)</source>
        <translation>Tabellen (*.csv)</translation>
    </message>
    <message>
        <source>Puts the longest axis along z and the middle one along x. This is only a first guess: check it, then correct it by numbers or touches.</source>
        <translation>Legt die längste Achse entlang z und die mittlere entlang x. Das ist nur eine erste Schätzung: Prüfen Sie sie und berichtigen Sie sie durch Zahlen oder Berührungen.</translation>
    </message>
    <message>
        <source>Height of the probe&apos;s lowest point above the sensor origin, mm</source>
        <translation>Höhe des tiefsten Punkts der Sonde über dem Sensorursprung, mm</translation>
    </message>
    <message>
        <source>Lowest point at</source>
        <translation>Tiefster Punkt bei</translation>
    </message>
    <message>
        <source>Align by shape</source>
        <translation>Nach der Form ausrichten</translation>
    </message>
    <message>
        <source>An alignment saved by contactbench.</source>
        <translation>Eine von contactbench gespeicherte Ausrichtung.</translation>
    </message>
    <message>
        <source>Choose alignment…</source>
        <translation>Ausrichtung wählen…</translation>
    </message>
    <message>
        <source>Alignment</source>
        <translation>Ausrichtung</translation>
    </message>
    <message>
        <source>Alignments (*.json)</source>
        <translation>Ausrichtungen (*.json)</translation>
    </message>
    <message>
        <source>Click the flat face of the mesh that sits on the sensor.</source>
        <translation>Klicken Sie die ebene Fläche des Netzes an, die auf dem Sensor sitzt.</translation>
    </message>
    <message>
        <source>Face selected. If you can, click a second point that shows the rotation about z.</source>
        <translation>Fläche gewählt. Klicken Sie, wenn möglich, einen zweiten Punkt an, der die Drehung um z zeigt.</translation>
    </message>
    <message>
        <source>Face and second point selected.</source>
        <translation>Fläche und zweiter Punkt gewählt.</translation>
    </message>
</context>
<context>
    <name>Bench</name>
    <message>
        <source>All devices are sending samples again. Recording continues.</source>
        <translation>Alle Geräte senden wieder Messwerte. Die Aufzeichnung geht weiter.</translation>
    </message>
</context>
<context>
    <name>CaptureState</name>
    <message>
        <source>not started</source>
        <translation>nicht begonnen</translation>
    </message>
    <message>
        <source>captured</source>
        <translation>aufgenommen</translation>
    </message>
    <message>
        <source>Turn the tool to the next pose.</source>
        <translation>Drehen Sie das Werkzeug in die nächste Pose.</translation>
    </message>
    <message>
        <source>still: press SPACE</source>
        <translation>ruhig: LEERTASTE drücken</translation>
    </message>
    <message>
        <source>Press SPACE to capture this pose.</source>
        <translation>Drücken Sie die LEERTASTE, um diese Pose aufzunehmen.</translation>
    </message>
    <message>
        <source>moving</source>
        <translation>bewegt sich</translation>
    </message>
    <message>
        <source>Hold the tool still.</source>
        <translation>Halten Sie das Werkzeug still.</translation>
    </message>
    <message>
        <source>settling</source>
        <translation>beruhigt sich</translation>
    </message>
    <message>
        <source>Keep still.</source>
        <translation>Weiter still halten.</translation>
    </message>
    <message>
        <source>still</source>
        <translation>ruhig</translation>
    </message>
    <message>
        <source>Keep still: averaging.</source>
        <translation>Still halten: Es wird gemittelt.</translation>
    </message>
    <message>
        <source>bumped</source>
        <translation>angestoßen</translation>
    </message>
    <message>
        <source>Keep still: capture restarts automatically.</source>
        <translation>Still halten: Die Aufnahme beginnt automatisch neu.</translation>
    </message>
    <message>
        <source>touched</source>
        <translation>berührt</translation>
    </message>
    <message>
        <source>Remove whatever is touching the tool.</source>
        <translation>Entfernen Sie alles, was das Werkzeug berührt.</translation>
    </message>
    <message>
        <source>no samples</source>
        <translation>keine Messwerte</translation>
    </message>
    <message>
        <source>The devices are not sending data.</source>
        <translation>Die Geräte senden keine Daten.</translation>
    </message>
    <message>
        <source>settling {seconds:.1f} s</source>
        <translation>beruhigt sich {seconds:.1f} s</translation>
    </message>
</context>
<context>
    <name>CheatSheet</name>
    <message>
        <source>Shortcuts</source>
        <translation>Tastenkürzel</translation>
    </message>
    <message>
        <source>Key</source>
        <translation>Taste</translation>
    </message>
    <message>
        <source>Action</source>
        <translation>Aktion</translation>
    </message>
    <message>
        <source>Enter</source>
        <translation>Eingabe</translation>
    </message>
    <message>
        <source>Do what the button at the foot of the page says</source>
        <translation>Tun, was die Schaltfläche unten auf der Seite sagt</translation>
    </message>
    <message>
        <source>Backspace</source>
        <translation>Rücktaste</translation>
    </message>
    <message>
        <source>Press the second button (bench mode)</source>
        <translation>Zweite Schaltfläche drücken (Messplatzmodus)</translation>
    </message>
    <message>
        <source>Page Up, Page Down</source>
        <translation>Bild auf, Bild ab</translation>
    </message>
    <message>
        <source>Previous or next step (bench mode)</source>
        <translation>Voriger oder nächster Schritt (Messplatzmodus)</translation>
    </message>
    <message>
        <source>Delete</source>
        <translation>Entf</translation>
    </message>
    <message>
        <source>Leave out the selected poses; remove the selected markers</source>
        <translation>Gewählte Posen auslassen; gewählte Marker entfernen</translation>
    </message>
    <message>
        <source>Return</source>
        <translation>Return</translation>
    </message>
    <message>
        <source>Restore the selected poses</source>
        <translation>Gewählte Posen wieder einbeziehen</translation>
    </message>
    <message>
        <source>Arrow keys</source>
        <translation>Pfeiltasten</translation>
    </message>
    <message>
        <source>Choose a point in the facets chart; move a range handle</source>
        <translation>Punkt im Facettendiagramm wählen; Griff eines Bereichs verschieben</translation>
    </message>
    <message>
        <source>Drag with the left or right button</source>
        <translation>Mit linker oder rechter Taste ziehen</translation>
    </message>
    <message>
        <source>Rotate the view</source>
        <translation>Ansicht drehen</translation>
    </message>
    <message>
        <source>Drag with the middle button</source>
        <translation>Mit mittlerer Taste ziehen</translation>
    </message>
    <message>
        <source>Pan the view</source>
        <translation>Ansicht verschieben</translation>
    </message>
    <message>
        <source>Wheel</source>
        <translation>Mausrad</translation>
    </message>
    <message>
        <source>Zoom in or out</source>
        <translation>Hinein- oder herauszoomen</translation>
    </message>
    <message>
        <source>Ctrl + wheel</source>
        <translation>Strg + Mausrad</translation>
    </message>
    <message>
        <source>Larger or smaller brush</source>
        <translation>Größerer oder kleinerer Pinsel</translation>
    </message>
    <message>
        <source>Hold Shift</source>
        <translation>Umschalt halten</translation>
    </message>
    <message>
        <source>Swap brush and eraser</source>
        <translation>Pinsel und Radierer vertauschen</translation>
    </message>
    <message>
        <source>Esc</source>
        <translation>Esc</translation>
    </message>
    <message>
        <source>Have the probe go back (motion control)</source>
        <translation>Sonde zurückziehen (Bewegungsregelung)</translation>
    </message>
    <message>
        <source>P</source>
        <translation>P</translation>
    </message>
    <message>
        <source>Play or pause (heatmap viewer)</source>
        <translation>Abspielen oder anhalten (Heatmap-Betrachter)</translation>
    </message>
    <message>
        <source>Ctrl+S</source>
        <translation>Strg+S</translation>
    </message>
    <message>
        <source>Save a picture (heatmap viewer)</source>
        <translation>Bild speichern (Heatmap-Betrachter)</translation>
    </message>
</context>
<context>
    <name>Checklist</name>
    <message>
        <source>Open step</source>
        <translation>Schritt öffnen</translation>
    </message>
    <message>
        <source>Open {name}</source>
        <translation>{name} öffnen</translation>
    </message>
</context>
<context>
    <name>ColourBar</name>
    <message>
        <source>darkest: up to {largest:.3g}</source>
        <translation>am dunkelsten: bis {largest:.3g}</translation>
    </message>
    <message>
        <source>{title}: from {low:.3g} to {high:.3g}</source>
        <translation>{title}: von {low:.3g} bis {high:.3g}</translation>
    </message>
</context>
<context>
    <name>ColourMenu</name>
    <message>
        <source>{0} (in use)</source>
        <translation>{0} (in Gebrauch)</translation>
    </message>
    <message>
        <source>Other colour…</source>
        <translation>Andere Farbe…</translation>
    </message>
    <message>
        <source>Orange</source>
        <translation>Orange</translation>
    </message>
    <message>
        <source>Sky blue</source>
        <translation>Himmelblau</translation>
    </message>
    <message>
        <source>Green</source>
        <translation>Grün</translation>
    </message>
    <message>
        <source>Yellow</source>
        <translation>Gelb</translation>
    </message>
    <message>
        <source>Blue</source>
        <translation>Blau</translation>
    </message>
    <message>
        <source>Red-orange</source>
        <translation>Rotorange</translation>
    </message>
    <message>
        <source>Pink</source>
        <translation>Rosa</translation>
    </message>
    <message>
        <source>Region colour</source>
        <translation>Farbe der Region</translation>
    </message>
</context>
<context>
    <name>Coverage</name>
    <message>
        <source>Coverage of gravity directions</source>
        <translation>Abdeckung der Schwerkraftrichtungen</translation>
    </message>
    <message>
        <source>Poses: {taken} captured, {left} left out, {rejected} rejected</source>
        <translation>Posen: {taken} aufgenommen, {left} ausgelassen, {rejected} abgelehnt</translation>
    </message>
    <message>
        <source>gravity towards the tool (+z)</source>
        <translation>zum Werkzeug hin (+z)</translation>
    </message>
    <message>
        <source>away from the tool (-z)</source>
        <translation>vom Werkzeug weg (-z)</translation>
    </message>
    <message>
        <source>Gravity directions in the sensor frame. Filled: captured; hollow: left out; cross: rejected; ring: next pose; dark dot: now. Well-spread poses give the best calibration.</source>
        <translation>Schwerkraftrichtungen im Sensorsystem. Gefüllt: aufgenommen; hohl: ausgelassen; Kreuz: abgelehnt; Ring: nächste Pose; dunkler Punkt: jetzt. Weit verteilte Posen ergeben die beste Kalibrierung.</translation>
    </message>
</context>
<context>
    <name>Departure</name>
    <message>
        <source>Work in progress</source>
        <translation>Laufende Arbeit</translation>
    </message>
    <message>
        <source>Stopping keeps all settings and recordings. The computation starts again when you reopen the session.</source>
        <translation>Beim Stoppen bleiben alle Einstellungen und Aufzeichnungen erhalten. Beim nächsten Öffnen der Sitzung wird neu gerechnet.</translation>
    </message>
    <message>
        <source>Stopping keeps everything recorded so far. You can continue from there next time.</source>
        <translation>Beim Stoppen bleibt alles bisher Aufgezeichnete erhalten. Sie können beim nächsten Mal dort weitermachen.</translation>
    </message>
    <message>
        <source>Wait until done</source>
        <translation>Warten, bis es fertig ist</translation>
    </message>
    <message>
        <source>Stop and keep results</source>
        <translation>Stoppen, Ergebnisse behalten</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>The session closes as soon as the work is done. You can keep working until then.</source>
        <translation>Die Sitzung schließt, sobald die Arbeit fertig ist. Bis dahin können Sie weiterarbeiten.</translation>
    </message>
</context>
<context>
    <name>DeviceChannels</name>
    <message>
        <source>Noise and headroom per channel</source>
        <translation>Rauschen und Reserve je Kanal</translation>
    </message>
    <message>
        <source>channel</source>
        <translation>Kanal</translation>
    </message>
    <message>
        <source>noise</source>
        <translation>Rauschen</translation>
    </message>
    <message>
        <source>Standard deviation of one reading at rest, N or N·m</source>
        <translation>Standardabweichung eines Messwerts in Ruhe, N oder N·m</translation>
    </message>
    <message>
        <source>largest</source>
        <translation>größter</translation>
    </message>
    <message>
        <source>Largest absolute reading in the last 5 s, N or N·m</source>
        <translation>Größter Betrag eines Messwerts in den letzten 5 s, N oder N·m</translation>
    </message>
    <message>
        <source>of range</source>
        <translation>v. Bereich</translation>
    </message>
    <message>
        <source>Share of the sensor&apos;s range; readings above 100 % are clipped</source>
        <translation>Anteil am Messbereich des Sensors; Werte über 100 % werden abgeschnitten</translation>
    </message>
    <message>
        <source>unknown</source>
        <translation>unbekannt</translation>
    </message>
</context>
<context>
    <name>DeviceTrial</name>
    <message>
        <source>Connection</source>
        <translation>Verbindung</translation>
    </message>
    <message>
        <source>Measured readings per second</source>
        <translation>Gemessene Messwerte pro Sekunde</translation>
    </message>
    <message>
        <source>– Hz</source>
        <translation>– Hz</translation>
    </message>
    <message>
        <source>{rate:.0f} Hz</source>
        <translation>{rate:.0f} Hz</translation>
    </message>
    <message>
        <source>Not connected</source>
        <translation>Nicht verbunden</translation>
    </message>
    <message>
        <source>Connected</source>
        <translation>Verbunden</translation>
    </message>
    <message>
        <source>Waiting</source>
        <translation>Wartet</translation>
    </message>
    <message>
        <source>Silent</source>
        <translation>Stumm</translation>
    </message>
    <message>
        <source>Lost</source>
        <translation>Verloren</translation>
    </message>
    <message>
        <source>Ended</source>
        <translation>Beendet</translation>
    </message>
    <message>
        <source>no gaps</source>
        <translation>keine Lücken</translation>
    </message>
    <message>
        <source>{count} gaps in 5 s, longest {longest:.0f} ms</source>
        <translation>{count} Lücken in 5 s, längste {longest:.0f} ms</translation>
    </message>
    <message>
        <source>no poses</source>
        <translation>keine Posen</translation>
    </message>
    <message>
        <source>poses {rate:.0f} Hz</source>
        <translation>Posen {rate:.0f} Hz</translation>
    </message>
    <message>
        <source>{samples:,} readings, {lost:,} lost, {gaps}; {poses}</source>
        <translation>{samples:,} Messwerte, {lost:,} verloren, {gaps}; {poses}</translation>
    </message>
</context>
<context>
    <name>DevicesPage</name>
    <message>
        <source>see the sensor&apos;s label</source>
        <translation>siehe Typenschild</translation>
    </message>
    <message>
        <source>Sensor serial number</source>
        <translation>Seriennummer des Sensors</translation>
    </message>
    <message>
        <source>Mounting angle about {axis}</source>
        <translation>Montagewinkel um {axis}</translation>
    </message>
    <message>
        <source>Rotation of the sensor on the flange about the flange&apos;s fixed axes, in the order x, y, z</source>
        <translation>Drehung des Sensors auf dem Flansch um die festen Flanschachsen, in der Reihenfolge x, y, z</translation>
    </message>
    <message>
        <source>Test connection</source>
        <translation>Verbindung testen</translation>
    </message>
    <message>
        <source>Use these devices</source>
        <translation>Diese Geräte nutzen</translation>
    </message>
    <message>
        <source>Devices</source>
        <translation>Geräte</translation>
    </message>
    <message>
        <source>for the report</source>
        <translation>für den Bericht</translation>
    </message>
    <message>
        <source>Number of the sensor&apos;s calibration certificate</source>
        <translation>Nummer des Kalibrierscheins des Sensors</translation>
    </message>
    <message>
        <source>YYYY-MM-DD</source>
        <translation>JJJJ-MM-TT</translation>
    </message>
    <message>
        <source>Date until which the certificate is valid, YYYY-MM-DD</source>
        <translation>Datum, bis zu dem der Kalibrierschein gilt, JJJJ-MM-TT</translation>
    </message>
    <message>
        <source>Mounting</source>
        <translation>Montage</translation>
    </message>
    <message>
        <source>Identification</source>
        <translation>Kennzeichnung</translation>
    </message>
    <message>
        <source>Sensor on the flange</source>
        <translation>Sensor am Flansch</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>Seriennummer</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>Kalibrierschein</translation>
    </message>
    <message>
        <source>Valid until</source>
        <translation>Gültig bis</translation>
    </message>
    <message>
        <source>Measured</source>
        <translation>Gemessen</translation>
    </message>
    <message>
        <source>Address for commands: {}</source>
        <translation>Adresse für Befehle: {}</translation>
    </message>
    <message>
        <source>Next: Gravity</source>
        <translation>Weiter: Schwerkraft</translation>
    </message>
    <message>
        <source>These devices are recording. Stop the recording before you change them.</source>
        <translation>Mit diesen Geräten läuft eine Aufzeichnung. Beenden Sie sie, bevor Sie die Geräte wechseln.</translation>
    </message>
    <message>
        <source>Opening devices…</source>
        <translation>Geräte werden geöffnet…</translation>
    </message>
    <message>
        <source>Testing connection</source>
        <translation>Die Verbindung wird getestet</translation>
    </message>
    <message>
        <source>choose devices</source>
        <translation>Geräte wählen</translation>
    </message>
    <message>
        <source>Opening devices</source>
        <translation>Die Geräte werden geöffnet</translation>
    </message>
    <message>
        <source>Could not open the devices: {why}</source>
        <translation>Die Geräte konnten nicht geöffnet werden: {why}</translation>
    </message>
    <message>
        <source>Could not save the device settings: {why}</source>
        <translation>Die Geräteeinstellungen konnten nicht gespeichert werden: {why}</translation>
    </message>
    <message>
        <source>Closing devices</source>
        <translation>Die Geräte werden geschlossen</translation>
    </message>
    <message>
        <source>{} Hz</source>
        <translation>{} Hz</translation>
    </message>
    <message>
        <source>samples</source>
        <translation>Messwerte</translation>
    </message>
</context>
<context>
    <name>Docks</name>
    <message>
        <source>Steps</source>
        <translation>Schritte</translation>
    </message>
    <message>
        <source>Step</source>
        <translation>Schritt</translation>
    </message>
    <message>
        <source>Charts</source>
        <translation>Diagramme</translation>
    </message>
    <message>
        <source>Messages</source>
        <translation>Meldungen</translation>
    </message>
</context>
<context>
    <name>ErrorView</name>
    <message>
        <source>Mean error</source>
        <translation>Mittlerer Fehler</translation>
    </message>
    <message>
        <source>{mean}{spread} mm</source>
        <translation>{mean}{spread} mm</translation>
    </message>
    <message>
        <source>last {size} mm</source>
        <translation>zuletzt {size} mm</translation>
    </message>
</context>
<context>
    <name>ExportPage</name>
    <message>
        <source>Export</source>
        <translation>Export</translation>
    </message>
    <message>
        <source>Contents</source>
        <translation>Inhalt</translation>
    </message>
    <message>
        <source>Settings</source>
        <translation>Einstellungen</translation>
    </message>
    <message>
        <source>Export without verification</source>
        <translation>Ohne Überprüfung exportieren</translation>
    </message>
    <message>
        <source>For trials only: the bundle is marked as not verified</source>
        <translation>Nur für Versuche: Das Paket wird als nicht überprüft gekennzeichnet</translation>
    </message>
    <message>
        <source>Export file…</source>
        <translation>Als Datei…</translation>
    </message>
    <message>
        <source>One zip file that a robot&apos;s runtime loads directly</source>
        <translation>Eine Zip-Datei, die der Robotercomputer direkt lädt</translation>
    </message>
    <message>
        <source>Export folder…</source>
        <translation>Als Ordner…</translation>
    </message>
    <message>
        <source>Open report</source>
        <translation>Bericht öffnen</translation>
    </message>
    <message>
        <source>Show in folder</source>
        <translation>Im Ordner zeigen</translation>
    </message>
    <message>
        <source>Robot payload</source>
        <translation>Nutzlast des Roboters</translation>
    </message>
    <message>
        <source>Live outputs</source>
        <translation>Live-Ausgaben</translation>
    </message>
    <message>
        <source>Checking the bundle</source>
        <translation>Das Paket wird geprüft</translation>
    </message>
    <message>
        <source>The sensor rate is unknown because nothing has been verified. Verify in step 5, or enter Readings under Settings to match the sensor.</source>
        <translation>Die Rate des Sensors ist unbekannt, weil noch nichts überprüft wurde. Überprüfen Sie in Schritt 5, oder geben Sie unter „Einstellungen“ bei „Messwerte“ die Rate des Sensors ein.</translation>
    </message>
    <message>
        <source>total {size}, SHA-256 {sha256}…</source>
        <translation>gesamt {size}, SHA-256 {sha256}…</translation>
    </message>
    <message>
        <source>Nothing has been exported from this session yet.</source>
        <translation>Aus dieser Sitzung wurde noch nichts exportiert.</translation>
    </message>
    <message>
        <source>Changes since the last export:</source>
        <translation>Änderungen seit dem letzten Export:</translation>
    </message>
    <message>
        <source>Not verified: {why}</source>
        <translation>Nicht überprüft: {why}</translation>
    </message>
    <message>
        <source>Verified and exported.</source>
        <translation>Überprüft und exportiert.</translation>
    </message>
    <message>
        <source>Verified and ready to export.</source>
        <translation>Überprüft und bereit zum Export.</translation>
    </message>
    <message>
        <source>Export file</source>
        <translation>Als Datei exportieren</translation>
    </message>
    <message>
        <source>Bundles (*.zip)</source>
        <translation>Pakete (*.zip)</translation>
    </message>
    <message>
        <source>Export folder: enter a name</source>
        <translation>Als Ordner exportieren: Namen eingeben</translation>
    </message>
    <message>
        <source>Exporting</source>
        <translation>Export läuft</translation>
    </message>
</context>
<context>
    <name>ExportSettingsPanel</name>
    <message>
        <source>Sensor model</source>
        <translation>Modell des Sensors</translation>
    </message>
    <message>
        <source>unknown</source>
        <translation>unbekannt</translation>
    </message>
    <message>
        <source>Sensor</source>
        <translation>Sensor</translation>
    </message>
    <message>
        <source>Sensor serial number</source>
        <translation>Seriennummer des Sensors</translation>
    </message>
    <message>
        <source>from the session</source>
        <translation>aus der Sitzung</translation>
    </message>
    <message>
        <source>Serial number</source>
        <translation>Seriennummer</translation>
    </message>
    <message>
        <source>Sensor name in the robot description, for ros2.yaml</source>
        <translation>Name des Sensors in der Roboterbeschreibung, für ros2.yaml</translation>
    </message>
    <message>
        <source>enter later</source>
        <translation>später eintragen</translation>
    </message>
    <message>
        <source>ROS name</source>
        <translation>ROS-Name</translation>
    </message>
    <message>
        <source>Person responsible</source>
        <translation>Verantwortliche Person</translation>
    </message>
    <message>
        <source>author of the latest result</source>
        <translation>Person hinter dem neuesten Ergebnis</translation>
    </message>
    <message>
        <source>Operator</source>
        <translation>Bedienperson</translation>
    </message>
    <message>
        <source>Filter wrench</source>
        <translation>Kraft/Moment filtern</translation>
    </message>
    <message>
        <source>Kalman filter: less noise; follows changes at once</source>
        <translation>Kalman-Filter: weniger Rauschen; folgt Änderungen sofort</translation>
    </message>
    <message>
        <source>Accept contacts on regions only</source>
        <translation>Nur Kontakte auf Regionen annehmen</translation>
    </message>
    <message>
        <source>The runtime rejects contacts outside all painted regions</source>
        <translation>Der Robotercomputer verwirft Kontakte außerhalb aller gemalten Regionen</translation>
    </message>
    <message>
        <source>Controller gains</source>
        <translation>Reglerverstärkungen</translation>
    </message>
    <message>
        <source>Controller gains for pressing and following: gains.json from contactbench bench control tune</source>
        <translation>Reglerverstärkungen für Drücken und Folgen: gains.json von contactbench bench control tune</translation>
    </message>
    <message>
        <source>Remove gains</source>
        <translation>Verstärkungen entfernen</translation>
    </message>
    <message>
        <source>Gains</source>
        <translation>Verstärkungen</translation>
    </message>
    <message>
        <source>Open gains</source>
        <translation>Verstärkungen öffnen</translation>
    </message>
    <message>
        <source>Gains (*.json)</source>
        <translation>Verstärkungen (*.json)</translation>
    </message>
    <message>
        <source>{name}; left empty: {otherwise}</source>
        <translation>{name}; leer gelassen: {otherwise}</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>weggelassen</translation>
    </message>
    <message>
        <source>{force:g} N, {variant}</source>
        <translation>{force:g} N, {variant}</translation>
    </message>
    <message>
        <source>predictive</source>
        <translation>vorausschauend</translation>
    </message>
    <message>
        <source>basic</source>
        <translation>einfach</translation>
    </message>
</context>
<context>
    <name>FacetsSection</name>
    <message>
        <source>4  Facets</source>
        <translation>4  Facetten</translation>
    </message>
    <message>
        <source>Overlay the original</source>
        <translation>Original überlagern</translation>
    </message>
    <message>
        <source>Colour by deviation</source>
        <translation>Nach Abweichung färben</translation>
    </message>
    <message>
        <source>Distance from the outer surface to the simplified surface, mm</source>
        <translation>Abstand der Außenfläche zur vereinfachten Fläche, mm</translation>
    </message>
    <message>
        <source>Number of facets, or mm</source>
        <translation>Anzahl der Facetten, oder mm</translation>
    </message>
    <message>
        <source>Limit by</source>
        <translation>Begrenzen nach</translation>
    </message>
    <message>
        <source>Limit</source>
        <translation>Grenze</translation>
    </message>
    <message>
        <source>Copy painted regions</source>
        <translation>Gemalte Regionen übernehmen</translation>
    </message>
    <message>
        <source>{:,} facets</source>
        <translation>{:,} Facetten</translation>
    </message>
</context>
<context>
    <name>Faults</name>
    <message>
        <source>The disk is full ({}). Earlier recordings are safe. Free some space, then try again.</source>
        <translation>Der Datenträger ist voll ({}). Frühere Aufzeichnungen sind sicher. Schaffen Sie Platz und versuchen Sie es noch einmal.</translation>
    </message>
    <message>
        <source>Not enough memory. Close other programs or use a smaller file, then try again.</source>
        <translation>Der Arbeitsspeicher reicht nicht. Schließen Sie andere Programme oder nehmen Sie eine kleinere Datei, und versuchen Sie es noch einmal.</translation>
    </message>
</context>
<context>
    <name>FileField</name>
    <message>
        <source>Choose…</source>
        <translation>Wählen…</translation>
    </message>
</context>
<context>
    <name>FindingCards</name>
    <message>
        <source>Findings</source>
        <translation>Befunde</translation>
    </message>
    <message>
        <source>Apply fix</source>
        <translation>Korrigieren</translation>
    </message>
</context>
<context>
    <name>GravityFigures</name>
    <message>
        <source>contact error from calibration (1 sigma)</source>
        <translation>Kontaktfehler durch die Kalibrierung (1 Sigma)</translation>
    </message>
    <message>
        <source>Contact error caused by the calibration alone, mm: worst case over the intended touches. 0.5 mm is good.</source>
        <translation>Kontaktfehler allein durch die Kalibrierung, mm: schlechtester Fall der vorgesehenen Berührungen. 0.5 mm ist gut.</translation>
    </message>
    <message>
        <source>Error after each pose, logarithmic scale; dashed: 0.5 mm, the limit for good</source>
        <translation>Fehler nach jeder Pose, logarithmische Skala; gestrichelt: 0.5 mm, die Grenze für gut</translation>
    </message>
    <message>
        <source>pose {count} of about {expected}</source>
        <translation>Pose {count} von etwa {expected}</translation>
    </message>
    <message>
        <source>{count} poses: you can finish</source>
        <translation>{count} Posen: Abschließen möglich</translation>
    </message>
    <message>
        <source>poses: {count}</source>
        <translation>Posen: {count}</translation>
    </message>
</context>
<context>
    <name>GravityPage</name>
    <message>
        <source>Capture this pose (gravity)</source>
        <translation>Diese Pose aufnehmen (Schwerkraft)</translation>
    </message>
    <message>
        <source>contact error from calibration (1 sigma)</source>
        <translation>Kontaktfehler durch die Kalibrierung (1 Sigma)</translation>
    </message>
    <message>
        <source>Action failed</source>
        <translation>Aktion fehlgeschlagen</translation>
    </message>
    <message>
        <source>Checked with a new pose</source>
        <translation>Mit einer neuen Pose geprüft</translation>
    </message>
    <message>
        <source>So far: {level}</source>
        <translation>Bisher: {level}</translation>
    </message>
    <message>
        <source>A calibration needs at least three poses.</source>
        <translation>Eine Kalibrierung braucht mindestens drei Posen.</translation>
    </message>
    <message>
        <source>Open Devices</source>
        <translation>Geräte öffnen</translation>
    </message>
    <message>
        <source>Starting…</source>
        <translation>Wird gestartet…</translation>
    </message>
    <message>
        <source>Finish</source>
        <translation>Beenden</translation>
    </message>
    <message>
        <source>Computing…</source>
        <translation>Wird berechnet…</translation>
    </message>
    <message>
        <source>Waiting for a still pose…</source>
        <translation>Wartet auf eine ruhige Pose…</translation>
    </message>
    <message>
        <source>poses captured</source>
        <translation>Posen erfasst</translation>
    </message>
    <message>
        <source>poses captured, of about {}</source>
        <translation>Posen erfasst, von etwa {}</translation>
    </message>
    <message>
        <source>Capture pose {} of {}</source>
        <translation>Pose {} von {} erfassen</translation>
    </message>
    <message>
        <source>Move virtual tool there</source>
        <translation>Virtuelles Werkzeug bewegen</translation>
    </message>
    <message>
        <source>Start over</source>
        <translation>Neu beginnen</translation>
    </message>
    <message>
        <source>Continue {recording}</source>
        <translation>{recording} fortsetzen</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Starten</translation>
    </message>
    <message>
        <source>Add poses</source>
        <translation>Posen hinzufügen</translation>
    </message>
    <message>
        <source>Check with another pose</source>
        <translation>Mit weiterer Pose prüfen</translation>
    </message>
    <message>
        <source>Next: Probe</source>
        <translation>Weiter: Sonde</translation>
    </message>
    <message>
        <source>set the tilt limit to {degrees}°</source>
        <translation>Neigungsgrenze auf {degrees}° setzen</translation>
    </message>
    <message>
        <source>set the down direction</source>
        <translation>Abwärtsrichtung angeben</translation>
    </message>
    <message>
        <source>set the orientation accuracy</source>
        <translation>Genauigkeit der Orientierung angeben</translation>
    </message>
</context>
<context>
    <name>GravityPanel</name>
    <message>
        <source>Gravity</source>
        <translation>Schwerkraft</translation>
    </message>
    <message>
        <source>Hold the tool still in about six different tilts, touching nothing. These poses determine the tool&apos;s weight and the sensor offset, which are then subtracted from every reading.</source>
        <translation>Halten Sie das Werkzeug in etwa sechs verschiedenen Neigungen still, ohne etwas zu berühren. Aus diesen Posen werden das Gewicht des Werkzeugs und der Nullpunkt des Sensors bestimmt und dann von jedem Messwert abgezogen.</translation>
    </message>
    <message>
        <source>Capture automatically when still</source>
        <translation>Automatisch aufnehmen, wenn ruhig</translation>
    </message>
    <message>
        <source>Off: press SPACE or the foot switch to capture each pose.</source>
        <translation>Aus: Jede Pose mit der LEERTASTE oder dem Fußschalter aufnehmen.</translation>
    </message>
    <message>
        <source>Bump virtual tool</source>
        <translation>Virtuelles Werkzeug anstoßen</translation>
    </message>
    <message>
        <source>Push the virtual tool briefly to see the effect</source>
        <translation>Das virtuelle Werkzeug kurz anstoßen, um die Wirkung zu sehen</translation>
    </message>
    <message>
        <source>Leave out</source>
        <translation>Auslassen</translation>
    </message>
    <message>
        <source>Restore</source>
        <translation>Wieder einbeziehen</translation>
    </message>
    <message>
        <source>Leave out the selected poses (Delete)</source>
        <translation>Die gewählten Posen auslassen (Entf)</translation>
    </message>
    <message>
        <source>End without a calibration; the poses are kept, and you can continue from them</source>
        <translation>Ohne Kalibrierung beenden; die Posen bleiben erhalten und können fortgesetzt werden</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Stopp</translation>
    </message>
    <message>
        <source>Restore the selected poses (Return)</source>
        <translation>Die gewählten Posen wieder einbeziehen (Return)</translation>
    </message>
    <message>
        <source>Add poses</source>
        <translation>Posen hinzufügen</translation>
    </message>
    <message>
        <source>Start over</source>
        <translation>Neu beginnen</translation>
    </message>
    <message>
        <source>Tilt limit of the tool</source>
        <translation>Größte Neigung des Werkzeugs</translation>
    </message>
    <message>
        <source>Largest angle between the sensor&apos;s z axis and straight down, degrees. Poses beyond it are not proposed.</source>
        <translation>Größter Winkel zwischen der z-Achse des Sensors und senkrecht nach unten, in Grad; Posen darüber hinaus werden nicht vorgeschlagen.</translation>
    </message>
    <message>
        <source>Robot base</source>
        <translation>Roboterbasis</translation>
    </message>
    <message>
        <source>upright</source>
        <translation>aufrecht</translation>
    </message>
    <message>
        <source>on the ceiling</source>
        <translation>an der Decke</translation>
    </message>
    <message>
        <source>on a wall, +x down</source>
        <translation>an der Wand, +x nach unten</translation>
    </message>
    <message>
        <source>on a wall, -x down</source>
        <translation>an der Wand, -x nach unten</translation>
    </message>
    <message>
        <source>on a wall, +y down</source>
        <translation>an der Wand, +y nach unten</translation>
    </message>
    <message>
        <source>on a wall, -y down</source>
        <translation>an der Wand, -y nach unten</translation>
    </message>
    <message>
        <source>Direction of gravity in the frame of the orientations. For other directions: session set calibration.down</source>
        <translation>Richtung der Schwerkraft im Koordinatensystem der Orientierungen. Andere Richtungen: session set calibration.down</translation>
    </message>
    <message>
        <source>from a robot ({degrees}°)</source>
        <translation>vom Roboter ({degrees}°)</translation>
    </message>
    <message>
        <source>from a tracker ({degrees}°)</source>
        <translation>vom Tracker ({degrees}°)</translation>
    </message>
    <message>
        <source>by hand ({degrees}°)</source>
        <translation>von Hand ({degrees}°)</translation>
    </message>
    <message>
        <source>Orientation accuracy</source>
        <translation>Genauigkeit der Orientierung</translation>
    </message>
    <message>
        <source>from the poses</source>
        <translation>aus den Posen</translation>
    </message>
    <message>
        <source>1 sigma about each axis. Orientation errors shift the weight in the readings.</source>
        <translation>1 Sigma um jede Achse. Fehler der Orientierung verschieben das Gewicht in den Messwerten.</translation>
    </message>
    <message>
        <source>Tilt the tool to match the ghost: {words}</source>
        <translation>Werkzeug wie den Umriss neigen: {words}</translation>
    </message>
    <message>
        <source>In position: keep still.</source>
        <translation>In Position: still halten.</translation>
    </message>
    <message>
        <source>{angle:.0f}° to go.</source>
        <translation>noch {angle:.0f}°.</translation>
    </message>
</context>
<context>
    <name>GravityRun</name>
    <message>
        <source>Loading calibration</source>
        <translation>Die Kalibrierung wird geladen</translation>
    </message>
    <message>
        <source>Compensating readings</source>
        <translation>Messwerte werden kompensiert</translation>
    </message>
    <message>
        <source>Starting recording</source>
        <translation>Die Aufzeichnung beginnt</translation>
    </message>
    <message>
        <source>Opening devices. The first pose can be captured afterwards.</source>
        <translation>Die Geräte werden geöffnet. Danach kann die erste Pose aufgenommen werden.</translation>
    </message>
    <message>
        <source>No device is open. Choose and open a sensor under Devices first.</source>
        <translation>Kein Gerät ist geöffnet. Wählen und öffnen Sie zuerst unter Geräte einen Sensor.</translation>
    </message>
    <message>
        <source>No pose source. The sensor&apos;s orientation is needed to separate the weight from the sensor offset. Choose a robot, a pose file or the virtual bench under Devices.</source>
        <translation>Keine Quelle für Posen. Um das Gewicht vom Nullpunkt des Sensors zu trennen, muss seine Orientierung bekannt sein. Wählen Sie unter Geräte einen Roboter, eine Datei mit Posen oder den virtuellen Messplatz.</translation>
    </message>
    <message>
        <source>calibrate gravity</source>
        <translation>Schwerkraft kalibrieren</translation>
    </message>
    <message>
        <source>Gravity: {why}</source>
        <translation>Schwerkraft: {why}</translation>
    </message>
    <message>
        <source>Computing calibration</source>
        <translation>Die Kalibrierung wird berechnet</translation>
    </message>
    <message>
        <source>Saving recording</source>
        <translation>Die Aufzeichnung wird gesichert</translation>
    </message>
    <message>
        <source>The calibration was checked with a new pose and is good.</source>
        <translation>Die Kalibrierung wurde mit einer neuen Pose geprüft und ist gut.</translation>
    </message>
    <message>
        <source>The calibration was checked with a new pose and is usable.</source>
        <translation>Die Kalibrierung wurde mit einer neuen Pose geprüft und ist brauchbar.</translation>
    </message>
    <message>
        <source>The calibration failed the check with a new pose. Do not use it.</source>
        <translation>Die Kalibrierung hat die Prüfung mit einer neuen Pose nicht bestanden. Benutzen Sie sie nicht.</translation>
    </message>
    <message>
        <source>Saving check</source>
        <translation>Die Prüfung wird gespeichert</translation>
    </message>
    <message>
        <source>leave out {poses}</source>
        <translation>{poses} auslassen</translation>
    </message>
    <message>
        <source>restore {poses}</source>
        <translation>{poses} wieder einbeziehen</translation>
    </message>
    <message>
        <source>No pose was changed because the calibration is still being computed. Try again in a moment.</source>
        <translation>Es wurde keine Pose geändert, weil die Kalibrierung noch berechnet wird. Versuchen Sie es gleich noch einmal.</translation>
    </message>
    <message>
        <source>Saving settings</source>
        <translation>Die Einstellungen werden gespeichert</translation>
    </message>
    <message>
        <source>Reopening devices with the new mount</source>
        <translation>Die Geräte werden mit der neuen Montage neu geöffnet</translation>
    </message>
</context>
<context>
    <name>HeaderBar</name>
    <message>
        <source>Header</source>
        <translation>Kopfzeile</translation>
    </message>
    <message>
        <source>No session</source>
        <translation>Keine Sitzung</translation>
    </message>
    <message>
        <source>no devices chosen</source>
        <translation>keine Geräte gewählt</translation>
    </message>
    <message>
        <source>{} · not connected</source>
        <translation>{} · nicht verbunden</translation>
    </message>
    <message>
        <source>{} · {:.0f} Hz · {} lost</source>
        <translation>{} · {:.0f} Hz · {} verloren</translation>
    </message>
    <message>
        <source>virtual bench</source>
        <translation>virtueller Messplatz</translation>
    </message>
    <message>
        <source>replay of {}</source>
        <translation>Wiedergabe von {}</translation>
    </message>
</context>
<context>
    <name>HeatmapControls</name>
    <message>
        <source>Contact density</source>
        <translation>Kontaktdichte</translation>
    </message>
    <message>
        <source>Mean force</source>
        <translation>Mittlere Kraft</translation>
    </message>
    <message>
        <source>Peak force</source>
        <translation>Größte Kraft</translation>
    </message>
    <message>
        <source>Mean error</source>
        <translation>Mittlerer Fehler</translation>
    </message>
    <message>
        <source>Uncertainty (1 sigma)</source>
        <translation>Unsicherheit (1 Sigma)</translation>
    </message>
    <message>
        <source>Quantity</source>
        <translation>Größe</translation>
    </message>
    <message>
        <source>Meaning of the colours. Density: per mm2; forces: N; error and uncertainty: mm.</source>
        <translation>Bedeutung der Farben. Dichte: pro mm2; Kräfte: N; Fehler und Unsicherheit: mm.</translation>
    </message>
    <message>
        <source>contact count</source>
        <translation>Anzahl der Kontakte</translation>
    </message>
    <message>
        <source>contact time in s</source>
        <translation>Kontaktzeit in s</translation>
    </message>
    <message>
        <source>contacts per second</source>
        <translation>Kontakte pro Sekunde</translation>
    </message>
    <message>
        <source>Density normalisation</source>
        <translation>Normierung der Dichte</translation>
    </message>
    <message>
        <source>The integral of the density over the whole surface.</source>
        <translation>Das Integral der Dichte über die ganze Oberfläche.</translation>
    </message>
    <message>
        <source>Bandwidth in mm</source>
        <translation>Bandbreite in mm</translation>
    </message>
    <message>
        <source>Standard deviation of the Gaussian that spreads each contact along the surface, mm.</source>
        <translation>Standardabweichung der Gauß-Glocke, die jeden Kontakt entlang der Oberfläche verteilt, mm.</translation>
    </message>
    <message>
        <source>Force range in N</source>
        <translation>Kraftbereich in N</translation>
    </message>
    <message>
        <source>Use only contacts with a force in this range, N.</source>
        <translation>Nur Kontakte mit einer Kraft in diesem Bereich verwenden, N.</translation>
    </message>
    <message>
        <source>Weight by confidence</source>
        <translation>Nach Sicherheit gewichten</translation>
    </message>
    <message>
        <source>Give uncertain contacts less weight.</source>
        <translation>Unsichere Kontakte zählen weniger.</translation>
    </message>
    <message>
        <source>Compare side by side</source>
        <translation>Nebeneinander vergleichen</translation>
    </message>
    <message>
        <source>Show a second heatmap with the same view and colour scale.</source>
        <translation>Eine zweite Heatmap mit derselben Ansicht und Farbskala zeigen.</translation>
    </message>
    <message>
        <source>from the first contact</source>
        <translation>ab dem ersten Kontakt</translation>
    </message>
    <message>
        <source>from each one&apos;s beginning</source>
        <translation>ab dem jeweiligen Anfang</translation>
    </message>
    <message>
        <source>Time of two that are compared</source>
        <translation>Zeit der beiden Verglichenen</translation>
    </message>
    <message>
        <source>Whether both times count from where the probe was touched first, or from where each file begins.</source>
        <translation>Ob beide Zeiten ab der ersten Berührung der Sonde zählen oder ab dem Anfang der jeweiligen Datei.</translation>
    </message>
    <message>
        <source>How much later the second one is shown, s</source>
        <translation>Um wie viel später die zweite gezeigt wird, s</translation>
    </message>
    <message>
        <source>Moves the second one against the first in time.</source>
        <translation>Verschiebt die zweite gegen die erste in der Zeit.</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Open files</source>
        <translation>Dateien öffnen</translation>
    </message>
    <message>
        <source>Recordings with their calibration and probe, contacts, or verifications.</source>
        <translation>Aufzeichnungen mit Kalibrierung und Sonde, Kontakte oder Überprüfungen.</translation>
    </message>
    <message>
        <source>Open session</source>
        <translation>Sitzung öffnen</translation>
    </message>
    <message>
        <source>Latest recording and verification of a session.</source>
        <translation>Die neueste Aufzeichnung und Überprüfung einer Sitzung.</translation>
    </message>
    <message>
        <source>Picture</source>
        <translation>Bild</translation>
    </message>
    <message>
        <source>Save the current view from two sides as .png.</source>
        <translation>Die aktuelle Ansicht von zwei Seiten als .png speichern.</translation>
    </message>
    <message>
        <source>Film</source>
        <translation>Film</translation>
    </message>
    <message>
        <source>Save the time window at the chosen speed as .mp4 or .gif.</source>
        <translation>Das Zeitfenster im gewählten Tempo als .mp4 oder .gif speichern.</translation>
    </message>
    <message>
        <source>Mesh</source>
        <translation>Netz</translation>
    </message>
    <message>
        <source>Save the vertex values as .ply or .glb (glTF).</source>
        <translation>Die Werte an den Eckpunkten als .ply oder .glb (glTF) speichern.</translation>
    </message>
    <message>
        <source>Equal factors are equal steps of colour, so that few contacts show beside many.</source>
        <translation>Gleiche Faktoren sind gleiche Farbschritte, sodass wenige Kontakte neben vielen zu sehen sind.</translation>
    </message>
    <message>
        <source>Logarithmic colours</source>
        <translation>Logarithmische Farben</translation>
    </message>
    <message>
        <source>Normalise to</source>
        <translation>Normieren auf</translation>
    </message>
    <message>
        <source>Bandwidth</source>
        <translation>Bandbreite</translation>
    </message>
    <message>
        <source>Force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>Time</source>
        <translation>Zeit</translation>
    </message>
    <message>
        <source>Second one later by</source>
        <translation>Zweite später um</translation>
    </message>
    <message>
        <source>Heatmap</source>
        <translation>Heatmap</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>A peak is the largest force: nothing is weighed in it.</source>
        <translation>Eine Spitze ist die größte Kraft: Dabei wird nichts gewichtet.</translation>
    </message>
    <message>
        <source>What is shown does not say how sure its contacts are: locate them again.</source>
        <translation>Die gezeigten Daten sagen nicht, wie sicher ihre Kontakte sind: Orten Sie sie neu.</translation>
    </message>
    <message>
        <source>Forces unknown.</source>
        <translation>Kräfte unbekannt.</translation>
    </message>
    <message>
        <source>{low:.1f} to {high:.1f} N</source>
        <translation>{low:.1f} bis {high:.1f} N</translation>
    </message>
    <message>
        <source>Nothing is shown yet: open files or a session first.</source>
        <translation>Noch ist nichts zu sehen: Öffnen Sie zuerst Dateien oder eine Sitzung.</translation>
    </message>
    <message>
        <source>{title}: {percent}</source>
        <translation>{title}: {percent}</translation>
    </message>
</context>
<context>
    <name>HeatmapExport</name>
    <message>
        <source>Picture (*.png)</source>
        <translation>Bild (*.png)</translation>
    </message>
    <message>
        <source>PLY mesh (*.ply);;Binary glTF (*.glb)</source>
        <translation>PLY-Netz (*.ply);;Binäres glTF (*.glb)</translation>
    </message>
    <message>
        <source>Save</source>
        <translation>Speichern</translation>
    </message>
    <message>
        <source>MP4 film (*.mp4)</source>
        <translation>MP4-Film (*.mp4)</translation>
    </message>
    <message>
        <source>Animated GIF (*.gif)</source>
        <translation>Animiertes GIF (*.gif)</translation>
    </message>
    <message>
        <source>Saving {name}</source>
        <translation>{name} wird gespeichert</translation>
    </message>
    <message>
        <source>Saved {names}.</source>
        <translation>Gespeichert: {names}.</translation>
    </message>
    <message>
        <source> and </source>
        <translation> und </translation>
    </message>
</context>
<context>
    <name>HeatmapViewer</name>
    <message>
        <source>Drop files here: a recording (.mcap) with its calibration (.json) and probe (.ply),
contacts (.csv) with the probe, a verification (.json) with the probe,
or a session folder, which contains all of them.</source>
        <translation>Dateien hier ablegen: eine Aufzeichnung (.mcap) mit Kalibrierung (.json) und Sonde (.ply),
Kontakte (.csv) mit der Sonde, eine Überprüfung (.json) mit der Sonde,
oder einen Sitzungsordner, der alles enthält.</translation>
    </message>
    <message>
        <source>Play or pause the time window (P).</source>
        <translation>Das Zeitfenster abspielen oder anhalten (P).</translation>
    </message>
    <message>
        <source>Nothing is shown yet: open files or a session first.</source>
        <translation>Noch ist nichts zu sehen: Öffnen Sie zuerst Dateien oder eine Sitzung.</translation>
    </message>
    <message>
        <source>The picture is in the clipboard.</source>
        <translation>Das Bild ist in der Zwischenablage.</translation>
    </message>
    <message>
        <source>Opening</source>
        <translation>Wird geöffnet</translation>
    </message>
    <message>
        <source>Now add contact data: a recording, contacts or a verification.</source>
        <translation>Fügen Sie jetzt Kontaktdaten hinzu: eine Aufzeichnung, Kontakte oder eine Überprüfung.</translation>
    </message>
    <message>
        <source>Reloading</source>
        <translation>Wird neu geladen</translation>
    </message>
    <message>
        <source>Open session folder</source>
        <translation>Sitzungsordner öffnen</translation>
    </message>
    <message>
        <source>Open recordings, contacts or verifications with probe and calibration</source>
        <translation>Aufzeichnungen, Kontakte oder Überprüfungen mit Sonde und Kalibrierung öffnen</translation>
    </message>
    <message>
        <source>Supported files ({});;All files (*)</source>
        <translation>Unterstützte Dateien ({});;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Computing heatmap</source>
        <translation>Die Heatmap wird berechnet</translation>
    </message>
    <message>
        <source>Heatmaps - contactbench</source>
        <translation>Heatmaps - contactbench</translation>
    </message>
</context>
<context>
    <name>HelpBook</name>
    <message>
        <source>Help</source>
        <translation>Hilfe</translation>
    </message>
    <message>
        <source>Search</source>
        <translation>Suchen</translation>
    </message>
    <message>
        <source>Search the help</source>
        <translation>In der Hilfe suchen</translation>
    </message>
    <message>
        <source>Pages</source>
        <translation>Seiten</translation>
    </message>
    <message>
        <source>No page has these words.</source>
        <translation>Keine Seite enthält diese Wörter.</translation>
    </message>
</context>
<context>
    <name>KnownCheckPanel</name>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Loading check</source>
        <translation>Prüfung lesen</translation>
    </message>
    <message>
        <source>Stopping recording</source>
        <translation>Aufnahme beenden</translation>
    </message>
    <message>
        <source>Starting recording</source>
        <translation>Aufnahme beginnen</translation>
    </message>
    <message>
        <source>Saving recording</source>
        <translation>Aufnahme sichern</translation>
    </message>
    <message>
        <source>Computing check</source>
        <translation>Prüfung berechnen</translation>
    </message>
    <message>
        <source>Outdated: check again</source>
        <translation>Veraltet: bitte neu prüfen</translation>
    </message>
</context>
<context>
    <name>LiveOutputsPanel</name>
    <message>
        <source>Address of {output}</source>
        <translation>Adresse: {output}</translation>
    </message>
    <message>
        <source>Allow other machines</source>
        <translation>Andere Rechner erlauben</translation>
    </message>
    <message>
        <source>Contacts are neither encrypted nor signed</source>
        <translation>Kontakte sind weder verschlüsselt noch signiert</translation>
    </message>
    <message>
        <source>Send contacts while devices are open, as contactbench run does.</source>
        <translation>Sendet Kontakte, solange Geräte offen sind, wie contactbench run.</translation>
    </message>
    <message>
        <source>{published:,} contacts sent, {lost:,} lost: the receiver is missing or too slow.</source>
        <translation>{published:,} Kontakte gesendet, {lost:,} verloren: Der Empfänger fehlt oder ist zu langsam.</translation>
    </message>
    <message>
        <source>{published:,} contacts sent.</source>
        <translation>{published:,} Kontakte gesendet.</translation>
    </message>
    <message>
        <source>Stop outputs</source>
        <translation>Ausgaben beenden</translation>
    </message>
    <message>
        <source>Start outputs</source>
        <translation>Ausgaben starten</translation>
    </message>
    <message>
        <source>Stopping outputs</source>
        <translation>Ausgaben werden beendet</translation>
    </message>
    <message>
        <source>Starting outputs</source>
        <translation>Ausgaben werden gestartet</translation>
    </message>
</context>
<context>
    <name>LiveView</name>
    <message>
        <source>Could not open this session&apos;s devices: {} Choose them again in step 1.</source>
        <translation>Die Geräte dieser Sitzung konnten nicht geöffnet werden: {} Wählen Sie sie in Schritt 1 neu.</translation>
    </message>
    <message>
        <source>Opening devices</source>
        <translation>Die Geräte werden geöffnet</translation>
    </message>
    <message>
        <source>no live samples</source>
        <translation>keine Messwerte</translation>
    </message>
    <message>
        <source>sensor {}</source>
        <translation>Sensor {}</translation>
    </message>
    <message>
        <source>poses {}</source>
        <translation>Posen {}</translation>
    </message>
    <message>
        <source>waiting</source>
        <translation>wartet</translation>
    </message>
    <message>
        <source>{:.0f} Hz</source>
        <translation>{:.0f} Hz</translation>
    </message>
</context>
<context>
    <name>MainWindow</name>
    <message>
        <source>Closing session</source>
        <translation>Die Sitzung wird geschlossen</translation>
    </message>
    <message>
        <source>done: {}</source>
        <translation>erledigt: {}</translation>
    </message>
    <message>
        <source>started</source>
        <translation>begonnen</translation>
    </message>
    <message>
        <source>Saving the current page</source>
        <translation>Die aktuelle Seite wird gespeichert</translation>
    </message>
    <message>
        <source>Step {} of {}: {}</source>
        <translation>Schritt {} von {}: {}</translation>
    </message>
</context>
<context>
    <name>MarkerTable</name>
    <message>
        <source>Marker</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>x  y  z</source>
        <translation>x  y  z</translation>
    </message>
    <message>
        <source>Touches</source>
        <translation>Berührt</translation>
    </message>
    <message>
        <source>Error</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Zustand</translation>
    </message>
    <message>
        <source>Position in the sensor frame S, mm</source>
        <translation>Lage im Sensorsystem S, mm</translation>
    </message>
    <message>
        <source>Accepted and required touches</source>
        <translation>Gezählte und nötige Berührungen</translation>
    </message>
    <message>
        <source>Mean error and largest error, mm</source>
        <translation>Mittlerer und größter Fehler, mm</translation>
    </message>
    <message>
        <source>Markers</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>{name}: x {x} mm, y {y} mm, z {z} mm</source>
        <translation>{name}: x {x} mm, y {y} mm, z {z} mm</translation>
    </message>
    <message>
        <source>open</source>
        <translation>offen</translation>
    </message>
    <message>
        <source>next</source>
        <translation>nächster</translation>
    </message>
    <message>
        <source>done</source>
        <translation>erledigt</translation>
    </message>
    <message>
        <source>too far off</source>
        <translation>zu weit weg</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>ausgelassen</translation>
    </message>
</context>
<context>
    <name>MarkersPanel</name>
    <message>
        <source>No markers yet. Distribute some over the probe, click on it, or import measured positions.</source>
        <translation>Noch keine Marker. Verteilen Sie welche auf der Sonde, klicken Sie darauf, oder importieren Sie gemessene Positionen.</translation>
    </message>
    <message>
        <source>Area for markers</source>
        <translation>Bereich für Marker</translation>
    </message>
    <message>
        <source>Place on</source>
        <translation>Setzen auf</translation>
    </message>
    <message>
        <source>Number of markers</source>
        <translation>Anzahl der Marker</translation>
    </message>
    <message>
        <source>Distribute evenly</source>
        <translation>Gleichmäßig verteilen</translation>
    </message>
    <message>
        <source>Grid spacing, mm</source>
        <translation>Abstand der Gitterlinien, mm</translation>
    </message>
    <message>
        <source>Create grid</source>
        <translation>Gitter anlegen</translation>
    </message>
    <message>
        <source>Click to place</source>
        <translation>Durch Klicken setzen</translation>
    </message>
    <message>
        <source>Click the probe to add a marker; if a marker is selected, the click moves it</source>
        <translation>Klick auf die Sonde setzt einen Marker; ein gewählter Marker wird stattdessen verschoben</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>Import…</source>
        <translation>Importieren…</translation>
    </message>
    <message>
        <source>Save as…</source>
        <translation>Speichern unter…</translation>
    </message>
    <message>
        <source>Snap to surface</source>
        <translation>Auf die Oberfläche setzen</translation>
    </message>
    <message>
        <source>Move every marker to the nearest point on the probe</source>
        <translation>Jeden Marker auf den nächsten Punkt der Sonde setzen</translation>
    </message>
    <message>
        <source>Marker {axis} in the sensor frame S, mm</source>
        <translation>{axis} des Markers im Sensorsystem S, mm</translation>
    </message>
    <message>
        <source>Add a marker at these coordinates</source>
        <translation>Einen Marker an diesen Koordinaten hinzufügen</translation>
    </message>
    <message>
        <source>region {rank}</source>
        <translation>Region {rank}</translation>
    </message>
    <message>
        <source>whole probe</source>
        <translation>ganze Sonde</translation>
    </message>
    <message>
        <source>Add marker</source>
        <translation>Marker hinzufügen</translation>
    </message>
    <message>
        <source>Move marker {name}</source>
        <translation>Marker {name} verschieben</translation>
    </message>
    <message>
        <source>Remove markers</source>
        <translation>Marker entfernen</translation>
    </message>
    <message>
        <source>Rename marker {name}</source>
        <translation>Marker {name} umbenennen</translation>
    </message>
    <message>
        <source>Place markers</source>
        <translation>Marker setzen</translation>
    </message>
    <message>
        <source>Snap markers to surface</source>
        <translation>Marker auf die Oberfläche setzen</translation>
    </message>
    <message>
        <source>Import markers</source>
        <translation>Marker importieren</translation>
    </message>
    <message>
        <source>Saving markers</source>
        <translation>Die Marker werden gespeichert</translation>
    </message>
    <message>
        <source>Markers saved in {file}.</source>
        <translation>Marker in {file} gespeichert.</translation>
    </message>
    <message>
        <source>Marker tables (*.csv)</source>
        <translation>Tabellen mit Markern (*.csv)</translation>
    </message>
    <message>
        <source>Save markers</source>
        <translation>Marker speichern</translation>
    </message>
</context>
<context>
    <name>Menus</name>
    <message>
        <source>&amp;File</source>
        <translation>&amp;Datei</translation>
    </message>
    <message>
        <source>&amp;New session…</source>
        <translation>&amp;Neue Sitzung…</translation>
    </message>
    <message>
        <source>Try the &amp;virtual bench</source>
        <translation>&amp;Virtuellen Messplatz ausprobieren</translation>
    </message>
    <message>
        <source>&amp;Open session…</source>
        <translation>Sitzung ö&amp;ffnen…</translation>
    </message>
    <message>
        <source>&amp;Recent sessions</source>
        <translation>&amp;Zuletzt benutzte Sitzungen</translation>
    </message>
    <message>
        <source>&amp;Reload session</source>
        <translation>Sitzung &amp;neu laden</translation>
    </message>
    <message>
        <source>&amp;Close session</source>
        <translation>Sitzung s&amp;chließen</translation>
    </message>
    <message>
        <source>Save &amp;diagnostics…</source>
        <translation>&amp;Diagnose speichern…</translation>
    </message>
    <message>
        <source>&amp;Quit</source>
        <translation>&amp;Beenden</translation>
    </message>
    <message>
        <source>&amp;Edit</source>
        <translation>&amp;Bearbeiten</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Rückgängig</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>&amp;Copy the picture of the 3D view</source>
        <translation>Bild der 3D-Ansicht &amp;kopieren</translation>
    </message>
    <message>
        <source>&amp;View</source>
        <translation>&amp;Ansicht</translation>
    </message>
    <message>
        <source>&amp;Reset layout</source>
        <translation>&amp;Anordnung zurücksetzen</translation>
    </message>
    <message>
        <source>Follow &amp;system</source>
        <translation>Wie &amp;System</translation>
    </message>
    <message>
        <source>&amp;Light</source>
        <translation>&amp;Hell</translation>
    </message>
    <message>
        <source>&amp;Dark</source>
        <translation>&amp;Dunkel</translation>
    </message>
    <message>
        <source>&amp;Theme</source>
        <translation>&amp;Farbschema</translation>
    </message>
    <message>
        <source>Follow s&amp;ystem</source>
        <translation>Wie S&amp;ystem</translation>
    </message>
    <message>
        <source>Lan&amp;guage</source>
        <translation>S&amp;prache</translation>
    </message>
    <message>
        <source>&amp;Bench mode</source>
        <translation>&amp;Messplatzmodus</translation>
    </message>
    <message>
        <source>Bench mode: readable from two metres, with three keys (F11)</source>
        <translation>Messplatzmodus: aus zwei Metern lesbar, mit drei Tasten (F11)</translation>
    </message>
    <message>
        <source>&amp;Full screen</source>
        <translation>&amp;Vollbild</translation>
    </message>
    <message>
        <source>&amp;Steps</source>
        <translation>&amp;Schritte</translation>
    </message>
    <message>
        <source>&amp;Tools</source>
        <translation>&amp;Werkzeuge</translation>
    </message>
    <message>
        <source>&amp;Heatmap viewer</source>
        <translation>&amp;Heatmap-Betrachter</translation>
    </message>
    <message>
        <source>&amp;Motion control on the virtual bench</source>
        <translation>&amp;Bewegungsregelung am virtuellen Messplatz</translation>
    </message>
    <message>
        <source>&amp;Help</source>
        <translation>&amp;Hilfe</translation>
    </message>
    <message>
        <source>&amp;This page</source>
        <translation>&amp;Diese Seite</translation>
    </message>
    <message>
        <source>&amp;Tutorial</source>
        <translation>&amp;Einführung</translation>
    </message>
    <message>
        <source>&amp;Documentation</source>
        <translation>&amp;Dokumentation</translation>
    </message>
    <message>
        <source>&amp;Shortcuts</source>
        <translation>&amp;Tastenkürzel</translation>
    </message>
    <message>
        <source>&amp;Log</source>
        <translation>&amp;Protokoll</translation>
    </message>
    <message>
        <source>&amp;About contactbench</source>
        <translation>&amp;Über contactbench</translation>
    </message>
    <message>
        <source>The picture of the 3D view is in the clipboard.</source>
        <translation>Das Bild der 3D-Ansicht ist in der Zwischenablage.</translation>
    </message>
    <message>
        <source>Longest UI stall {:.0f} ms; 99th percentile {:.0f} ms.</source>
        <translation>Längste Unterbrechung der Oberfläche {:.0f} ms; 99. Perzentil {:.0f} ms.</translation>
    </message>
    <message>
        <source>Logging is off.</source>
        <translation>Es wird kein Protokoll geführt.</translation>
    </message>
    <message>
        <source>Log</source>
        <translation>Protokoll</translation>
    </message>
    <message>
        <source>Heatmap viewer</source>
        <translation>Heatmap-Betrachter</translation>
    </message>
    <message>
        <source>Motion control on the virtual bench</source>
        <translation>Bewegungsregelung am virtuellen Messplatz</translation>
    </message>
    <message>
        <source>Save diagnostics</source>
        <translation>Diagnose speichern</translation>
    </message>
    <message>
        <source>Zip files (*.zip)</source>
        <translation>Zip-Dateien (*.zip)</translation>
    </message>
    <message>
        <source>Saving diagnostics</source>
        <translation>Die Diagnose wird gespeichert</translation>
    </message>
    <message>
        <source>Diagnostics saved as {}. They contain no recordings, meshes or names.</source>
        <translation>Diagnose als {} gespeichert. Sie enthält keine Aufzeichnungen, Netze oder Namen.</translation>
    </message>
    <message>
        <source>None yet</source>
        <translation>Noch keine</translation>
    </message>
    <message>
        <source>The language changes after a restart of contactbench.</source>
        <translation>Die Sprache wechselt nach einem Neustart von contactbench.</translation>
    </message>
</context>
<context>
    <name>MeshReport</name>
    <message>
        <source>The file leaves the unit of its numbers open: choose the length of the probe.</source>
        <translation>Die Datei lässt die Einheit ihrer Zahlen offen: Wählen Sie die Länge der Sonde.</translation>
    </message>
    <message>
        <source>The outer surface has none of the file&apos;s faults:</source>
        <translation>Die Außenfläche hat keinen der Fehler der Datei:</translation>
    </message>
    <message>
        <source>No problems found that affect contacts.</source>
        <translation>Keine Probleme gefunden, die Kontakte beeinträchtigen.</translation>
    </message>
    <message>
        <source>Show less</source>
        <translation>Weniger zeigen</translation>
    </message>
    <message>
        <source>Show {} more</source>
        <translation>{} weitere zeigen</translation>
    </message>
</context>
<context>
    <name>MeshSection</name>
    <message>
        <source>1  Mesh</source>
        <translation>1  Netz</translation>
    </message>
    <message>
        <source>Choose mesh…</source>
        <translation>Netz wählen…</translation>
    </message>
    <message>
        <source>How long is the probe? The file leaves its unit open. The grey card is a bank card of 86 mm.</source>
        <translation>Wie lang ist die Sonde? Die Datei lässt ihre Einheit offen. Die graue Karte ist eine Bankkarte von 86 mm.</translation>
    </message>
    <message>
        <source>Use virtual bench housing</source>
        <translation>Gehäuse des virtuellen Messplatzes nutzen</translation>
    </message>
    <message>
        <source>{}; you can also drop a file on the window</source>
        <translation>{}; Sie können auch eine Datei auf das Fenster ziehen</translation>
    </message>
    <message>
        <source>Drop the probe mesh from CAD or a scanner here, or choose a file.</source>
        <translation>Ziehen Sie das Netz der Sonde aus CAD oder vom Scanner hierher, oder wählen Sie eine Datei.</translation>
    </message>
    <message>
        <source>{:.4g} mm long ({})</source>
        <translation>{:.4g} mm lang ({})</translation>
    </message>
</context>
<context>
    <name>MessageList</name>
    <message>
        <source>Messages</source>
        <translation>Meldungen</translation>
    </message>
    <message>
        <source>Message details</source>
        <translation>Einzelheiten der Meldung</translation>
    </message>
    <message>
        <source>All</source>
        <translation>Alle</translation>
    </message>
    <message>
        <source>Warnings</source>
        <translation>Warnungen</translation>
    </message>
    <message>
        <source>Errors</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Filter: all messages, warnings and errors, or errors only</source>
        <translation>Filter: alle Meldungen, Warnungen und Fehler, oder nur Fehler</translation>
    </message>
    <message>
        <source>No messages.</source>
        <translation>Keine Meldungen.</translation>
    </message>
    <message>
        <source>Copy selected messages</source>
        <translation>Gewählte Meldungen kopieren</translation>
    </message>
    <message>
        <source>Message filter</source>
        <translation>Meldungsfilter</translation>
    </message>
    <message>
        <source>Details</source>
        <translation>Einzelheiten</translation>
    </message>
    <message>
        <source>Show details of the selected message</source>
        <translation>Einzelheiten der gewählten Meldung zeigen</translation>
    </message>
    <message>
        <source>Copy selected messages with details</source>
        <translation>Die gewählten Meldungen mit ihren Einzelheiten kopieren</translation>
    </message>
    <message>
        <source>Copy messages</source>
        <translation>Meldungen kopieren</translation>
    </message>
    <message>
        <source> ({} times)</source>
        <translation> ({}-mal)</translation>
    </message>
    <message>
        <source>No further details.</source>
        <translation>Keine weiteren Einzelheiten.</translation>
    </message>
    <message>
        <source>Select a message.</source>
        <translation>Wählen Sie eine Meldung.</translation>
    </message>
</context>
<context>
    <name>MessageRouter</name>
    <message>
        <source>Unexpected error: {}. Your session is safe. Try again. If the error persists, save diagnostics (File menu) and send them to your support contact.</source>
        <translation>Unerwarteter Fehler: {}. Ihre Sitzung ist sicher. Versuchen Sie es noch einmal. Tritt der Fehler wieder auf, speichern Sie die Diagnose (Menü Datei) und senden Sie sie an Ihre Ansprechperson.</translation>
    </message>
    <message>
        <source>{}: {}</source>
        <translation>{}: {}</translation>
    </message>
</context>
<context>
    <name>MotionControls</name>
    <message>
        <source>Elfin3 arm</source>
        <translation>Elfin3-Arm</translation>
    </message>
    <message>
        <source>stiff mount</source>
        <translation>steife Halterung</translation>
    </message>
    <message>
        <source>Robot</source>
        <translation>Roboter</translation>
    </message>
    <message>
        <source>Both are simulated; no real hardware moves.</source>
        <translation>Beide sind simuliert; keine echte Hardware bewegt sich.</translation>
    </message>
    <message>
        <source>rocks along the face</source>
        <translation>kippt längs der Fläche</translation>
    </message>
    <message>
        <source>rocks across the face</source>
        <translation>kippt quer zur Fläche</translation>
    </message>
    <message>
        <source>moves up and down</source>
        <translation>bewegt sich auf und ab</translation>
    </message>
    <message>
        <source>at rest</source>
        <translation>ruht</translation>
    </message>
    <message>
        <source>Phantom</source>
        <translation>Phantom</translation>
    </message>
    <message>
        <source>Motion of the soft phantom under the probe.</source>
        <translation>Bewegung des weichen Phantoms unter der Sonde.</translation>
    </message>
    <message>
        <source>{seconds:g} s</source>
        <translation>{seconds:g} s</translation>
    </message>
    <message>
        <source>Period</source>
        <translation>Periode</translation>
    </message>
    <message>
        <source>Period T of the phantom&apos;s motion.</source>
        <translation>Periode T der Bewegung des Phantoms.</translation>
    </message>
    <message>
        <source>from the bundle</source>
        <translation>aus dem Paket</translation>
    </message>
    <message>
        <source>predictive</source>
        <translation>vorausschauend</translation>
    </message>
    <message>
        <source>basic</source>
        <translation>einfach</translation>
    </message>
    <message>
        <source>Control</source>
        <translation>Regelung</translation>
    </message>
    <message>
        <source>Predictive: estimates the phantom&apos;s motion and leads it. Basic: force and position only.</source>
        <translation>Vorausschauend: schätzt die Bewegung des Phantoms und nimmt sie vorweg. Einfach: nur Kraft und Position.</translation>
    </message>
    <message>
        <source>Amplitude of the phantom&apos;s motion to each side.</source>
        <translation>Ausschlag des Phantoms, nach jeder Seite.</translation>
    </message>
    <message>
        <source>Amplitude</source>
        <translation>Amplitude</translation>
    </message>
    <message>
        <source>Controller state</source>
        <translation>Zustand der Regelung</translation>
    </message>
    <message>
        <source>Force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>Angle to the phantom</source>
        <translation>Winkel zum Phantom</translation>
    </message>
    <message>
        <source>How fast its time goes, against the clock: 1.00 is real time. Measured over the last frames.</source>
        <translation>Wie schnell die Zeit der Simulation gegen die Uhr läuft: 1.00 ist Echtzeit. Über die letzten Bilder gemessen.</translation>
    </message>
    <message>
        <source>Use a bundle of the open session in its current state.</source>
        <translation>Ein Paket aus dem jetzigen Stand der offenen Sitzung nutzen.</translation>
    </message>
    <message>
        <source>Use session</source>
        <translation>Sitzung nutzen</translation>
    </message>
    <message>
        <source>An exported folder or zip file.</source>
        <translation>Ein exportierter Ordner oder eine exportierte Zip-Datei.</translation>
    </message>
    <message>
        <source>Open bundle</source>
        <translation>Paket öffnen</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Starten</translation>
    </message>
    <message>
        <source>Retract the probe and stop (Esc).</source>
        <translation>Die Sonde zurückziehen und anhalten (Esc).</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Stopp</translation>
    </message>
    <message>
        <source>Nothing moves any more; it is about to end.</source>
        <translation>Nichts bewegt sich mehr; der Lauf endet gleich.</translation>
    </message>
    <message>
        <source>No bundle</source>
        <translation>Kein Paket</translation>
    </message>
    <message>
        <source>Choose the bundle that is to be run.</source>
        <translation>Wählen Sie das Paket, das laufen soll.</translation>
    </message>
    <message>
        <source>Opening the bundle</source>
        <translation>Das Paket wird geöffnet</translation>
    </message>
    <message>
        <source>Ready</source>
        <translation>Bereit</translation>
    </message>
    <message>
        <source>Nothing moves until you press Start.</source>
        <translation>Nichts bewegt sich, bis Sie Starten drücken.</translation>
    </message>
    <message>
        <source>Starting</source>
        <translation>Startet</translation>
    </message>
    <message>
        <source>The virtual robot is being made.</source>
        <translation>Der virtuelle Roboter wird angelegt.</translation>
    </message>
    <message>
        <source>Stopping</source>
        <translation>Hält an</translation>
    </message>
    <message>
        <source>The probe leaves the phantom, then stands still.</source>
        <translation>Die Sonde verlässt das Phantom und steht dann still.</translation>
    </message>
    <message>
        <source>Ended</source>
        <translation>Beendet</translation>
    </message>
    <message>
        <source>The probe stands still; nothing moves any more.</source>
        <translation>Die Sonde steht still; nichts bewegt sich mehr.</translation>
    </message>
    <message>
        <source>Failed</source>
        <translation>Fehlgeschlagen</translation>
    </message>
    <message>
        <source>Nothing moves any more; the message says why.</source>
        <translation>Nichts bewegt sich mehr; die Meldung sagt, warum.</translation>
    </message>
    <message>
        <source>Motion control</source>
        <translation>Bewegungsregelung</translation>
    </message>
    <message>
        <source>force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>angle to the phantom</source>
        <translation>Winkel zum Phantom</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>°</source>
        <translation>°</translation>
    </message>
    <message>
        <source>{:z.1f} N</source>
        <translation>{:z.1f} N</translation>
    </message>
    <message>
        <source>{:.1f}°</source>
        <translation>{:.1f}°</translation>
    </message>
    <message>
        <source>Pace: –</source>
        <translation>Tempo: –</translation>
    </message>
    <message>
        <source>Pace: {pace:.2f} of real time</source>
        <translation>Tempo: {pace:.2f} der Echtzeit</translation>
    </message>
    <message>
        <source>Pace: {pace:.2f} of real time: this computer is too slow</source>
        <translation>Tempo: {pace:.2f} der Echtzeit: Dieser Rechner ist zu langsam</translation>
    </message>
    <message>
        <source>{time:.1f} s  {state}: {why}</source>
        <translation>{time:.1f} s  {state}: {why}</translation>
    </message>
    <message>
        <source>Approaching</source>
        <translation>Nähert sich</translation>
    </message>
    <message>
        <source>The probe is slowly approaching the phantom.</source>
        <translation>Die Sonde nähert sich langsam dem Phantom.</translation>
    </message>
    <message>
        <source>In contact</source>
        <translation>In Kontakt</translation>
    </message>
    <message>
        <source>The force rises, then the stiffness is estimated.</source>
        <translation>Die Kraft steigt, dann wird die Steifigkeit geschätzt.</translation>
    </message>
    <message>
        <source>Tracking</source>
        <translation>Folgt</translation>
    </message>
    <message>
        <source>Keeps its force and stays perpendicular.</source>
        <translation>Hält die Kraft und bleibt senkrecht.</translation>
    </message>
    <message>
        <source>Holding</source>
        <translation>Hält an</translation>
    </message>
    <message>
        <source>Waiting until the readings are reliable again.</source>
        <translation>Wartet, bis die Messwerte wieder verlässlich sind.</translation>
    </message>
    <message>
        <source>Retracting</source>
        <translation>Zieht sich zurück</translation>
    </message>
    <message>
        <source>The probe is leaving the phantom.</source>
        <translation>Die Sonde löst sich vom Phantom.</translation>
    </message>
    <message>
        <source>Stopped</source>
        <translation>Angehalten</translation>
    </message>
</context>
<context>
    <name>MotionWindow</name>
    <message>
        <source>Choose a bundle, then press Start. Everything is simulated; no real hardware moves.</source>
        <translation>Wählen Sie ein Paket und drücken Sie Starten. Alles ist simuliert; keine echte Hardware bewegt sich.</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Stopp</translation>
    </message>
    <message>
        <source>This page</source>
        <translation>Diese Seite</translation>
    </message>
    <message>
        <source>No session is open. Open one or choose a bundle.</source>
        <translation>Keine Sitzung ist offen. Öffnen Sie eine, oder wählen Sie ein Paket.</translation>
    </message>
    <message>
        <source>Creating bundle</source>
        <translation>Ein Paket wird erstellt</translation>
    </message>
    <message>
        <source>Opening bundle</source>
        <translation>Ein Paket wird geöffnet</translation>
    </message>
    <message>
        <source>{name}: {facets:,} facets.</source>
        <translation>{name}: {facets:,} Facetten.</translation>
    </message>
    <message>
        <source>Not verified: for trials only.</source>
        <translation>Nicht überprüft: nur für Versuche.</translation>
    </message>
    <message>
        <source>The bundle does not state the sensor&apos;s mounting; no rotation is assumed.</source>
        <translation>Das Paket gibt die Montage des Sensors nicht an; es wird keine Drehung angenommen.</translation>
    </message>
    <message>
        <source>The bundle has no gains; the defaults for its probe are used.</source>
        <translation>Das Paket hat keine Verstärkungen; die Standardwerte für seine Sonde werden verwendet.</translation>
    </message>
    <message>
        <source>Contact force {force:g} N.</source>
        <translation>Kontaktkraft {force:g} N.</translation>
    </message>
    <message>
        <source>Open bundle</source>
        <translation>Ein Paket öffnen</translation>
    </message>
    <message>
        <source>Bundles (*.zip contactbench.json);;All files (*)</source>
        <translation>Pakete (*.zip contactbench.json);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Tracked for {seconds:.0f} s at {low:.1f} to {high:.1f} N; mean angle error {within:.1f}° along the face and {out:.1f}° across it.</source>
        <translation>{seconds:.0f} s lang gefolgt mit {low:.1f} bis {high:.1f} N; mittlerer Winkelfehler {within:.1f}° längs der Fläche und {out:.1f}° quer dazu.</translation>
    </message>
</context>
<context>
    <name>NetworkField</name>
    <message>
        <source>Host name or IP address</source>
        <translation>Rechnername oder IP-Adresse</translation>
    </message>
</context>
<context>
    <name>NewestMessage</name>
    <message>
        <source>Newest message</source>
        <translation>Neueste Meldung</translation>
    </message>
</context>
<context>
    <name>Pages</name>
    <message>
        <source>Checking session</source>
        <translation>Die Sitzung wird geprüft</translation>
    </message>
</context>
<context>
    <name>PayloadPanel</name>
    <message>
        <source>Robot</source>
        <translation>Roboter</translation>
    </message>
    <message>
        <source>Sensor origin on the flange, {axis}</source>
        <translation>Ursprung des Sensors am Flansch, {axis}</translation>
    </message>
    <message>
        <source>Mass of the sensor</source>
        <translation>Masse des Sensors</translation>
    </message>
    <message>
        <source>With its adapters; the sensor does not feel its own weight</source>
        <translation>Mit seinen Adaptern; der Sensor spürt sein eigenes Gewicht nicht</translation>
    </message>
    <message>
        <source>Centre of mass of the sensor, {axis}</source>
        <translation>Schwerpunkt des Sensors, {axis}</translation>
    </message>
    <message>
        <source>Payload for the robot&apos;s controller</source>
        <translation>Nutzlast für die Robotersteuerung</translation>
    </message>
    <message>
        <source>Copy payload</source>
        <translation>Nutzlast kopieren</translation>
    </message>
    <message>
        <source>Sensor at</source>
        <translation>Sensor bei</translation>
    </message>
    <message>
        <source>Sensor mass</source>
        <translation>Sensormasse</translation>
    </message>
    <message>
        <source>Its centre</source>
        <translation>Schwerpunkt</translation>
    </message>
    <message>
        <source>Calibrate first.</source>
        <translation>Kalibrieren Sie zuerst.</translation>
    </message>
    <message>
        <source>Too unsure to tell a robot: calibrate with poses that tilt farther.</source>
        <translation>Zu ungenau für einen Roboter: Kalibrieren Sie mit stärker geneigten Posen.</translation>
    </message>
    <message>
        <source>Standard deviation {mass:.1f} g and at most {centre:.1f} mm.</source>
        <translation>Standardabweichung {mass:.1f} g und höchstens {centre:.1f} mm.</translation>
    </message>
    <message>
        <source>The sensor&apos;s own mass is not included.</source>
        <translation>Die Masse des Sensors selbst ist nicht enthalten.</translation>
    </message>
    <message>
        <source>The sensor is taken as not turned on the flange.</source>
        <translation>Der Sensor gilt als nicht gegen den Flansch gedreht.</translation>
    </message>
    <message>
        <source>The payload is in the clipboard.</source>
        <translation>Die Nutzlast ist in der Zwischenablage.</translation>
    </message>
    <message>
        <source>Payload</source>
        <translation>Nutzlast</translation>
    </message>
</context>
<context>
    <name>Picture</name>
    <message>
        <source>Force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>target</source>
        <translation>Sollwert</translation>
    </message>
    <message>
        <source>angle along the face</source>
        <translation>Winkel längs der Fläche</translation>
    </message>
    <message>
        <source>across the face</source>
        <translation>quer zur Fläche</translation>
    </message>
    <message>
        <source>Angle to the phantom</source>
        <translation>Winkel zum Phantom</translation>
    </message>
</context>
<context>
    <name>PlaceSection</name>
    <message>
        <source>3  Alignment with sensor</source>
        <translation>3  Ausrichtung am Sensor</translation>
    </message>
    <message>
        <source>move the mesh</source>
        <translation>Netz bewegen</translation>
    </message>
    <message>
        <source>Aligning mesh</source>
        <translation>Das Netz wird ausgerichtet</translation>
    </message>
</context>
<context>
    <name>PointPanel</name>
    <message>
        <source>Known point</source>
        <translation>Bekannter Punkt</translation>
    </message>
    <message>
        <source>Press one marker on the side of the probe with a finger. This reveals wrong torque signs or units, and a probe rotated on the sensor.</source>
        <translation>Drücken Sie mit dem Finger auf einen Marker an der Seite der Sonde. So zeigen sich falsche Vorzeichen oder Einheiten der Drehmomente und eine auf dem Sensor verdrehte Sonde.</translation>
    </message>
    <message>
        <source>Marker</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>Record press</source>
        <translation>Druck aufnehmen</translation>
    </message>
    <message>
        <source>Place a marker on the Markers tab first.</source>
        <translation>Setzen Sie zuerst unter Marker einen Marker.</translation>
    </message>
</context>
<context>
    <name>PointTable</name>
    <message>
        <source>on the mesh</source>
        <translation>auf dem Netz</translation>
    </message>
    <message>
        <source>Matching points: on the mesh and in the sensor frame, mm</source>
        <translation>Punktpaare: auf dem Netz und im Sensorsystem, in mm</translation>
    </message>
    <message>
        <source>Enter each point&apos;s position in the sensor frame, mm</source>
        <translation>Geben Sie die Lage jedes Punkts im Sensorsystem ein, mm</translation>
    </message>
    <message>
        <source>Remove this point</source>
        <translation>Diesen Punkt entfernen</translation>
    </message>
</context>
<context>
    <name>PoseModel</name>
    <message>
        <source>Deviation of the reading from the fit to all poses, in standard deviations. About 1 is normal; check poses above 3.</source>
        <translation>Restabweichung: Abstand des Messwerts von der Anpassung an alle Posen, in Standardabweichungen. Etwa 1 ist normal; über 3 lohnt ein Blick.</translation>
    </message>
    <message>
        <source>Pose</source>
        <translation>Pose</translation>
    </message>
    <message>
        <source>Tilt</source>
        <translation>Neigung</translation>
    </message>
    <message>
        <source>Residual</source>
        <translation>Abw. (σ)</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Zustand</translation>
    </message>
    <message>
        <source>{name}, {words}, residual {sigmas} sigma, {state}</source>
        <translation>{name}, {words}, Restabweichung {sigmas} Sigma, {state}</translation>
    </message>
    <message>
        <source>force {force:.1f} sigma, torque {torque:.1f} sigma</source>
        <translation>Kraft {force:.1f} Sigma, Moment {torque:.1f} Sigma</translation>
    </message>
    <message>
        <source>From the interrupted recording.</source>
        <translation>Aus der unterbrochenen Aufzeichnung.</translation>
    </message>
    <message>
        <source>captured</source>
        <translation>aufgenommen</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>ausgelassen</translation>
    </message>
    <message>
        <source>rejected</source>
        <translation>abgelehnt</translation>
    </message>
</context>
<context>
    <name>PoseSource</name>
    <message>
        <source>Orientation</source>
        <translation>Orientierung</translation>
    </message>
    <message>
        <source>Robot address</source>
        <translation>Adresse des Roboters</translation>
    </message>
    <message>
        <source>Pose file</source>
        <translation>Datei mit Posen</translation>
    </message>
    <message>
        <source>Poses (*.csv);;All files (*)</source>
        <translation>Posen (*.csv);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Flange rotation about {axis}</source>
        <translation>Drehung des Flanschs um {axis}</translation>
    </message>
    <message>
        <source>From the sensor source</source>
        <translation>Aus der Sensorquelle</translation>
    </message>
    <message>
        <source>Robot</source>
        <translation>Roboter</translation>
    </message>
    <message>
        <source>Stationary</source>
        <translation>Feststehend</translation>
    </message>
    <message>
        <source>Enter address</source>
        <translation>Adresse eingeben</translation>
    </message>
    <message>
        <source>None</source>
        <translation>Keine</translation>
    </message>
    <message>
        <source>A virtual bench and most recordings include the orientation.</source>
        <translation>Ein virtueller Messplatz und die meisten Aufzeichnungen liefern auch die Orientierung.</translation>
    </message>
    <message>
        <source>Gravity cannot be calibrated without an orientation. Only raw readings are shown.</source>
        <translation>Ohne Orientierung kann die Schwerkraft nicht kalibriert werden. Nur rohe Messwerte werden gezeigt.</translation>
    </message>
    <message>
        <source>This sensor does not report its orientation. Choose the robot that moves it.</source>
        <translation>Dieser Sensor gibt seine Orientierung nicht an. Wählen Sie den Roboter, der ihn bewegt.</translation>
    </message>
    <message>
        <source>Choose a pose file.</source>
        <translation>Wählen Sie eine Datei mit Posen.</translation>
    </message>
</context>
<context>
    <name>ProbePage</name>
    <message>
        <source>Probe mesh</source>
        <translation>Netz der Sonde</translation>
    </message>
    <message>
        <source>Meshes</source>
        <translation>Netze</translation>
    </message>
    <message>
        <source>Probe</source>
        <translation>Sonde</translation>
    </message>
    <message>
        <source>Saving probe</source>
        <translation>Die Sonde wird behalten</translation>
    </message>
    <message>
        <source>Next: Regions</source>
        <translation>Weiter: Regionen</translation>
    </message>
    <message>
        <source>Use virtual bench housing</source>
        <translation>Gehäuse des virtuellen Messplatzes nutzen</translation>
    </message>
    <message>
        <source>Choose mesh…</source>
        <translation>Netz wählen…</translation>
    </message>
    <message>
        <source>Enter probe length (1)</source>
        <translation>Länge der Sonde angeben (1)</translation>
    </message>
    <message>
        <source>Create outer surface</source>
        <translation>Außenfläche machen</translation>
    </message>
    <message>
        <source>Apply placement</source>
        <translation>Lage anwenden</translation>
    </message>
    <message>
        <source>Align with sensor (3)</source>
        <translation>Am Sensor ausrichten (3)</translation>
    </message>
    <message>
        <source>Prepare probe</source>
        <translation>Sonde vorbereiten</translation>
    </message>
    <message>
        <source>Use this probe</source>
        <translation>Diese Sonde nutzen</translation>
    </message>
    <message>
        <source>{} from the outer surface.</source>
        <translation>{} von der Außenfläche.</translation>
    </message>
    <message>
        <source>Probe of this session.</source>
        <translation>Die Sonde der Sitzung.</translation>
    </message>
</context>
<context>
    <name>ProbeStages</name>
    <message>
        <source>deviation, mm</source>
        <translation>Abweichung, mm</translation>
    </message>
    <message>
        <source>keep the probe&apos;s draft</source>
        <translation>Entwurf der Sonde sichern</translation>
    </message>
    <message>
        <source>Reading {}</source>
        <translation>{} wird gelesen</translation>
    </message>
    <message>
        <source>Creating the virtual bench housing</source>
        <translation>Das Gehäuse des virtuellen Messplatzes wird erstellt</translation>
    </message>
    <message>
        <source>take the mesh {}</source>
        <translation>Netz {} nehmen</translation>
    </message>
    <message>
        <source>say the mesh&apos;s unit</source>
        <translation>Einheit des Netzes angeben</translation>
    </message>
    <message>
        <source>choose the tolerance of the STEP file</source>
        <translation>Toleranz der STEP-Datei wählen</translation>
    </message>
    <message>
        <source>choose how the outer surface is made</source>
        <translation>Außenfläche einstellen</translation>
    </message>
    <message>
        <source>Creating outer surface</source>
        <translation>Die Außenfläche wird erstellt</translation>
    </message>
    <message>
        <source>place the mesh</source>
        <translation>Netz platzieren</translation>
    </message>
    <message>
        <source>Aligning mesh</source>
        <translation>Das Netz wird ausgerichtet</translation>
    </message>
    <message>
        <source>Comparing facet counts</source>
        <translation>Anzahlen von Facetten werden verglichen</translation>
    </message>
    <message>
        <source>choose the number of facets</source>
        <translation>Facettenzahl wählen</translation>
    </message>
    <message>
        <source>Preparing probe</source>
        <translation>Die Sonde wird vorbereitet</translation>
    </message>
    <message>
        <source>use probe</source>
        <translation>die Sonde nutzen</translation>
    </message>
    <message>
        <source>The probe with {:,} facets is in use. Next: regions or verification.</source>
        <translation>Die Sonde mit {:,} Facetten ist in Gebrauch. Als Nächstes: Regionen oder Überprüfung.</translation>
    </message>
    <message>
        <source>Opening probe</source>
        <translation>Die Sonde wird geöffnet</translation>
    </message>
</context>
<context>
    <name>ProbeWorker</name>
    <message>
        <source>Stopped. Nothing was changed.</source>
        <translation>Angehalten. Nichts wurde geändert.</translation>
    </message>
    <message>
        <source>Unexpected error ({}). Nothing was changed. Try again.</source>
        <translation>Unerwarteter Fehler ({}). Nichts wurde geändert. Versuchen Sie es noch einmal.</translation>
    </message>
</context>
<context>
    <name>ProgressStrip</name>
    <message>
        <source>Progress</source>
        <translation>Fortschritt</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Stop this task; finished results are kept</source>
        <translation>Diese Arbeit anhalten; fertige Ergebnisse bleiben erhalten</translation>
    </message>
    <message>
        <source> (and {} more)</source>
        <translation> (und {} weitere)</translation>
    </message>
    <message>
        <source>Stopping</source>
        <translation>Wird angehalten</translation>
    </message>
    <message>
        <source>{} s</source>
        <translation>{} s</translation>
    </message>
</context>
<context>
    <name>ReadOnlyView</name>
    <message>
        <source>Read-only</source>
        <translation>Schreibgeschützt</translation>
    </message>
    <message>
        <source>Read-only: this session is damaged. To continue working, close it, open it again and salvage a copy.</source>
        <translation>Schreibgeschützt: Diese Sitzung ist beschädigt. Um weiterzuarbeiten, schließen Sie sie, öffnen Sie sie erneut und retten Sie eine Kopie.</translation>
    </message>
    <message>
        <source>Read-only: another program is using this session. It is shown as it was when opened.</source>
        <translation>Schreibgeschützt: Ein anderes Programm benutzt diese Sitzung. Sie wird so gezeigt, wie sie beim Öffnen war.</translation>
    </message>
    <message>
        <source>Read-only: the session folder is not writable. To continue working, make it writable or copy it.</source>
        <translation>Schreibgeschützt: Der Ordner dieser Sitzung ist nicht beschreibbar. Um weiterzuarbeiten, machen Sie ihn beschreibbar oder kopieren Sie ihn.</translation>
    </message>
</context>
<context>
    <name>ReadingBox</name>
    <message>
        <source>Reading recordings</source>
        <translation>Aufzeichnungen lesen</translation>
    </message>
    <message>
        <source>Sensor mount, degrees</source>
        <translation>Montage des Sensors, Grad</translation>
    </message>
    <message>
        <source>Off: mounting from the session, or no rotation. On: rotation about the flange&apos;s fixed axes x, y, z.</source>
        <translation>Aus: Montage aus der Sitzung, sonst keine Drehung. Ein: Drehung um die festen Achsen x, y, z des Flansches.</translation>
    </message>
    <message>
        <source>Mount about {axis}, degrees</source>
        <translation>Montage um {axis}, Grad</translation>
    </message>
    <message>
        <source>Delay of the wrench relative to its pose, ms</source>
        <translation>Verzögerung des Messwerts gegenüber seiner Pose, ms</translation>
    </message>
    <message>
        <source>Delay</source>
        <translation>Verzug</translation>
    </message>
</context>
<context>
    <name>RegionAutosave</name>
    <message>
        <source>Saving regions</source>
        <translation>Die Regionen werden behalten</translation>
    </message>
</context>
<context>
    <name>RegionBrush</name>
    <message>
        <source>No region selected. Add one or select one in the list, then paint.</source>
        <translation>Keine Region gewählt. Fügen Sie eine hinzu oder wählen Sie eine in der Liste, dann malen Sie.</translation>
    </message>
</context>
<context>
    <name>RegionListWidget</name>
    <message>
        <source>Regions, highest priority first</source>
        <translation>Regionen, die wichtigste zuerst</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Add a region with the lowest priority</source>
        <translation>Eine Region mit der niedrigsten Priorität hinzufügen</translation>
    </message>
    <message>
        <source>Colour</source>
        <translation>Farbe</translation>
    </message>
    <message>
        <source>Choose colour</source>
        <translation>Farbe wählen</translation>
    </message>
    <message>
        <source>Raise the priority (Alt+Up)</source>
        <translation>Priorität erhöhen (Alt+Hoch)</translation>
    </message>
    <message>
        <source>Lower the priority (Alt+Down)</source>
        <translation>Priorität senken (Alt+Herunter)</translation>
    </message>
    <message>
        <source>Remove the region; its facets become unassigned</source>
        <translation>Die Region entfernen; ihre Facetten gehören dann zu keiner</translation>
    </message>
    <message>
        <source>Raise region priority</source>
        <translation>Priorität der Region erhöhen</translation>
    </message>
    <message>
        <source>Lower region priority</source>
        <translation>Priorität der Region senken</translation>
    </message>
    <message>
        <source>Untouchable</source>
        <translation>Nicht berührbar</translation>
    </message>
    <message>
        <source>These facets cannot be touched, for example under a clamp or drape. Contacts there are treated as 1000 times less likely.</source>
        <translation>Diese Facetten sind nicht berührbar, etwa unter einer Klemme oder einem Tuch. Kontakte dort gelten als 1000-mal weniger wahrscheinlich.</translation>
    </message>
</context>
<context>
    <name>RegionRows</name>
    <message>
        <source>Priority</source>
        <translation>Priorität</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>cm²</source>
        <translation>cm²</translation>
    </message>
    <message>
        <source>Facets</source>
        <translation>Facetten</translation>
    </message>
    <message>
        <source>✕ {0} (untouchable)</source>
        <translation>✕ {0} (nicht berührbar)</translation>
    </message>
    <message>
        <source>{0}, untouchable, priority {1}, {2:.2f} cm²</source>
        <translation>{0}, nicht berührbar, Priorität {1}, {2:.2f} cm²</translation>
    </message>
    <message>
        <source>{0}, priority {1}, {2:.2f} cm²</source>
        <translation>{0}, Priorität {1}, {2:.2f} cm²</translation>
    </message>
    <message>
        <source>Priority {0}, colour {1}. Click to choose another colour.</source>
        <translation>Priorität {0}, Farbe {1}. Klicken Sie, um eine andere Farbe zu wählen.</translation>
    </message>
    <message>
        <source>Double-click to rename. Drag or press Alt+Up or Alt+Down to change the priority.</source>
        <translation>Doppelklick zum Umbenennen. Ziehen oder Alt+Hoch und Alt+Herunter ändert die Priorität.</translation>
    </message>
    <message>
        <source>Area: {0:.1f} mm²; facets: {1:,}.</source>
        <translation>Fläche: {0:.1f} mm²; Facetten: {1:,}.</translation>
    </message>
</context>
<context>
    <name>RegionsPage</name>
    <message>
        <source>Smaller brush</source>
        <translation>Kleinerer Pinsel</translation>
    </message>
    <message>
        <source>Larger brush</source>
        <translation>Größerer Pinsel</translation>
    </message>
    <message>
        <source>Cancel the stroke, or navigate</source>
        <translation>Strich abbrechen, oder navigieren</translation>
    </message>
    <message>
        <source>No probe yet. Prepare it first, then paint regions on it.</source>
        <translation>Noch keine Sonde. Bereiten Sie sie zuerst vor, dann malen Sie Regionen darauf.</translation>
    </message>
    <message>
        <source>Cancelled.</source>
        <translation>Abgebrochen.</translation>
    </message>
    <message>
        <source>Preparing the surface for painting</source>
        <translation>Die Fläche zum Bemalen wird vorbereitet</translation>
    </message>
    <message>
        <source>What was painted cannot be undone any more: the probe&apos;s surface has changed.</source>
        <translation>Das Gemalte lässt sich nicht mehr rückgängig machen: Die Oberfläche der Sonde hat sich geändert.</translation>
    </message>
    <message>
        <source>Facets: {0:,}; area: {1:.2f} cm²</source>
        <translation>Facetten: {0:,}; Fläche: {1:.2f} cm²</translation>
    </message>
    <message>
        <source>Finding facets</source>
        <translation>Die Facetten werden gesucht</translation>
    </message>
    <message>
        <source>No change: the region already has this shape.</source>
        <translation>Keine Änderung: Die Region hat schon diese Form.</translation>
    </message>
    <message>
        <source>apply regions to probe</source>
        <translation>Regionen auf die Sonde anwenden</translation>
    </message>
    <message>
        <source>Regions applied to the probe.</source>
        <translation>Die Regionen sind auf die Sonde angewendet.</translation>
    </message>
    <message>
        <source>Applying regions</source>
        <translation>Regionen werden angewendet</translation>
    </message>
    <message>
        <source>Import regions</source>
        <translation>Regionen importieren</translation>
    </message>
    <message>
        <source>Regions (*.json *.csv)</source>
        <translation>Regionen (*.json *.csv)</translation>
    </message>
    <message>
        <source>Export regions</source>
        <translation>Regionen exportieren</translation>
    </message>
    <message>
        <source>Reading regions</source>
        <translation>Regionen werden gelesen</translation>
    </message>
    <message>
        <source>Regions saved to {0}.</source>
        <translation>Regionen in {0} gespeichert.</translation>
    </message>
    <message>
        <source>Writing regions</source>
        <translation>Regionen werden geschrieben</translation>
    </message>
</context>
<context>
    <name>RegionsPanel</name>
    <message>
        <source>Regions</source>
        <translation>Regionen</translation>
    </message>
    <message>
        <source>Mark the areas meant to be touched, most important first. If a reading fits several places, these areas are preferred. Regions are optional.</source>
        <translation>Markieren Sie die Flächen, die berührt werden sollen, die wichtigsten zuerst. Passt ein Messwert zu mehreren Stellen, werden diese Flächen bevorzugt. Regionen sind optional.</translation>
    </message>
    <message>
        <source>Open Probe</source>
        <translation>Sonde öffnen</translation>
    </message>
    <message>
        <source>Apply regions</source>
        <translation>Regionen anwenden</translation>
    </message>
    <message>
        <source>Recompute the probe with more facets in the regions</source>
        <translation>Die Sonde mit mehr Facetten in den Regionen neu berechnen</translation>
    </message>
    <message>
        <source>Import…</source>
        <translation>Importieren…</translation>
    </message>
    <message>
        <source>Replace all regions with those in a JSON or CSV file</source>
        <translation>Alle Regionen durch die einer JSON- oder CSV-Datei ersetzen</translation>
    </message>
    <message>
        <source>Export…</source>
        <translation>Exportieren…</translation>
    </message>
    <message>
        <source>Save the regions to a JSON or CSV file</source>
        <translation>Die Regionen in einer JSON- oder CSV-Datei speichern</translation>
    </message>
    <message>
        <source>Next: Verify</source>
        <translation>Weiter: Prüfen</translation>
    </message>
    <message>
        <source>Next: Verify, without regions</source>
        <translation>Weiter: Prüfen, ohne Regionen</translation>
    </message>
    <message>
        <source>Add a region</source>
        <translation>Region hinzufügen</translation>
    </message>
    <message>
        <source>Preparing the surface for painting…</source>
        <translation>Die Fläche zum Bemalen wird vorbereitet…</translation>
    </message>
    <message>
        <source>Computing…</source>
        <translation>Wird berechnet.</translation>
    </message>
    <message>
        <source>The regions were not saved: {0} The next change tries again.</source>
        <translation>Die Regionen wurden nicht gespeichert: {0} Die nächste Änderung versucht es wieder.</translation>
    </message>
    <message>
        <source>No regions yet. Add one, then paint it on the probe.</source>
        <translation>Noch keine Regionen. Fügen Sie eine hinzu und malen Sie sie auf die Sonde.</translation>
    </message>
    <message>
        <source>Select a region in the list, then paint it on the probe.</source>
        <translation>Wählen Sie eine Region in der Liste und malen Sie sie auf die Sonde.</translation>
    </message>
    <message>
        <source>Nothing painted yet. Choose the brush and drag over the probe.</source>
        <translation>Noch nichts gemalt. Wählen Sie den Pinsel und ziehen Sie über die Sonde.</translation>
    </message>
    <message>
        <source>Saving…</source>
        <translation>Wird gespeichert…</translation>
    </message>
    <message>
        <source>Applied, but {0}</source>
        <translation>Angewendet, aber {0}</translation>
    </message>
    <message>
        <source>The probe has these regions.</source>
        <translation>Die Sonde hat diese Regionen.</translation>
    </message>
    <message>
        <source>Applied to the probe.</source>
        <translation>Auf die Sonde angewendet.</translation>
    </message>
    <message>
        <source>Saved. The regions are applied when the probe is prepared.</source>
        <translation>Gespeichert. Die Regionen werden beim Vorbereiten der Sonde angewendet.</translation>
    </message>
    <message>
        <source>Saved, but not yet applied to the probe.</source>
        <translation>Gespeichert, aber noch nicht auf die Sonde angewendet.</translation>
    </message>
</context>
<context>
    <name>ResidualTable</name>
    <message>
        <source>Poses</source>
        <translation>Posen</translation>
    </message>
    <message>
        <source>Leave out</source>
        <translation>Auslassen</translation>
    </message>
    <message>
        <source>Restore</source>
        <translation>Wieder einbeziehen</translation>
    </message>
</context>
<context>
    <name>ResultPanel</name>
    <message>
        <source>Open report</source>
        <translation>Bericht öffnen</translation>
    </message>
    <message>
        <source>Not verified yet</source>
        <translation>Noch nicht überprüft</translation>
    </message>
    <message>
        <source>Does not count</source>
        <translation>Zählt nicht</translation>
    </message>
    <message>
        <source>Outdated: verify again</source>
        <translation>Veraltet: erneut überprüfen</translation>
    </message>
    <message>
        <source>Passed</source>
        <translation>Bestanden</translation>
    </message>
    <message>
        <source>Not passed</source>
        <translation>Nicht bestanden</translation>
    </message>
    <message>
        <source>no accepted touches</source>
        <translation>keine Berührung zählte</translation>
    </message>
    <message>
        <source>{mean} mm</source>
        <translation>{mean} mm</translation>
    </message>
    <message>
        <source>error of a single touch</source>
        <translation>Fehler einer einzigen Berührung</translation>
    </message>
    <message>
        <source>mean error of {count} touches</source>
        <translation>mittlerer Fehler von {count} Berührungen</translation>
    </message>
    <message>
        <source>mean error of {count} touches; 95 % CI {low}–{high} mm</source>
        <translation>mittlerer Fehler von {count} Berührungen; 95-%-Konfidenzintervall {low}–{high} mm</translation>
    </message>
    <message>
        <source>Largest error: {size} mm (limit {limit} mm)</source>
        <translation>Größter Fehler: {size} mm (Grenze {limit} mm)</translation>
    </message>
    <message>
        <source>Limit of the mean error: {limit} mm</source>
        <translation>Grenze des mittleren Fehlers: {limit} mm</translation>
    </message>
    <message>
        <source>95 % of touches within {size} mm</source>
        <translation>95 % der Berührungen innerhalb von {size} mm</translation>
    </message>
    <message>
        <source>Details</source>
        <translation>Einzelheiten</translation>
    </message>
    <message>
        <source>Show the worst marker</source>
        <translation>Schlechteste Marke zeigen</translation>
    </message>
    <message>
        <source>Turn the 3D view to the marker with the largest error</source>
        <translation>Die 3D-Ansicht zur Marke mit dem größten Fehler drehen</translation>
    </message>
    <message>
        <source>{ratio} times the expected error (noise and calibration)</source>
        <translation>das {ratio}-Fache des erwarteten Fehlers (Rauschen und Kalibrierung)</translation>
    </message>
    <message>
        <source>Not counted: {listed}.</source>
        <translation>Nicht gezählt: {listed}.</translation>
    </message>
</context>
<context>
    <name>ScaleBar</name>
    <message>
        <source>Scale bar: {length}</source>
        <translation>Maßstab: {length}</translation>
    </message>
    <message>
        <source>{length:g} mm</source>
        <translation>{length:g} mm</translation>
    </message>
</context>
<context>
    <name>Scene</name>
    <message>
        <source>3D view of the probe</source>
        <translation>3D-Ansicht der Sonde</translation>
    </message>
    <message>
        <source>down</source>
        <translation>unten</translation>
    </message>
    <message>
        <source>error, mm</source>
        <translation>Fehler, mm</translation>
    </message>
    <message>
        <source>made up: hatched</source>
        <translation>ergänzt: schraffiert</translation>
    </message>
    <message>
        <source>made up: seam</source>
        <translation>ergänzt: Naht</translation>
    </message>
    <message>
        <source>untouchable: crossed</source>
        <translation>unberührbar: gekreuzt</translation>
    </message>
    <message>
        <source>error, {times} times</source>
        <translation>Fehler, {times}-fach</translation>
    </message>
    <message>
        <source>95 % of noise, {times} times</source>
        <translation>95 % des Rauschens, {times}-fach</translation>
    </message>
    <message>
        <source>possible alternative</source>
        <translation>mögliche Alternative</translation>
    </message>
</context>
<context>
    <name>SensorSource</name>
    <message>
        <source>Force/torque sensor</source>
        <translation>Kraft-Momenten-Sensor</translation>
    </message>
    <message>
        <source>Sensor made by {maker}</source>
        <translation>Sensor von {maker}</translation>
    </message>
    <message>
        <source>with the {name} probe</source>
        <translation>mit der Sonde {name}</translation>
    </message>
    <message>
        <source>Recording</source>
        <translation>Aufzeichnung</translation>
    </message>
    <message>
        <source>Recordings (*.mcap);;All files (*)</source>
        <translation>Aufzeichnungen (*.mcap);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Sensor manufacturer</source>
        <translation>Hersteller des Sensors</translation>
    </message>
    <message>
        <source>Virtual bench probe</source>
        <translation>Sonde des virtuellen Messplatzes</translation>
    </message>
    <message>
        <source>Sensor address</source>
        <translation>Adresse des Sensors</translation>
    </message>
    <message>
        <source>One of contactbench record devices, such as sri+tcp or line+udp, then :// and the device address</source>
        <translation>Eine aus contactbench record devices, etwa sri+tcp oder line+udp, dann :// und die Geräteadresse</translation>
    </message>
    <message>
        <source>Sensor on the network</source>
        <translation>Sensor im Netzwerk</translation>
    </message>
    <message>
        <source> (not plugged in)</source>
        <translation> (nicht eingesteckt)</translation>
    </message>
    <message>
        <source>Virtual bench</source>
        <translation>Virtueller Messplatz</translation>
    </message>
    <message>
        <source>Replay a recording</source>
        <translation>Aufzeichnung wiedergeben</translation>
    </message>
    <message>
        <source>Enter address</source>
        <translation>Adresse eingeben</translation>
    </message>
    <message>
        <source>{guess} sensor at {path}</source>
        <translation>{guess}-Sensor an {path}</translation>
    </message>
</context>
<context>
    <name>SessionProbe</name>
    <message>
        <source>Loading probe</source>
        <translation>Die Sonde wird geladen</translation>
    </message>
</context>
<context>
    <name>Sessions</name>
    <message>
        <source>Finding recent sessions</source>
        <translation>Zuletzt benutzte Sitzungen werden gesucht</translation>
    </message>
    <message>
        <source>Preparing virtual bench</source>
        <translation>Der virtuelle Messplatz wird vorbereitet</translation>
    </message>
    <message>
        <source>Opening {}</source>
        <translation>{} wird geöffnet</translation>
    </message>
    <message>
        <source>Opening {} up to the damage</source>
        <translation>{} wird bis zum Schaden geöffnet</translation>
    </message>
    <message>
        <source>Creating {}</source>
        <translation>{} wird angelegt</translation>
    </message>
    <message>
        <source>Create a session in a new or empty folder</source>
        <translation>Sitzung in einem neuen oder leeren Ordner anlegen</translation>
    </message>
    <message>
        <source>Create session</source>
        <translation>Sitzung anlegen</translation>
    </message>
    <message>
        <source>Open session folder</source>
        <translation>Sitzungsordner öffnen</translation>
    </message>
    <message>
        <source>The last run on {} ended unexpectedly during a recording. Everything up to half a second before that is intact. Add the recording to the session?</source>
        <translation>Die letzte Arbeit an {} endete unerwartet während einer Aufzeichnung. Alles bis eine halbe Sekunde davor ist erhalten. Die Aufzeichnung in die Sitzung übernehmen?</translation>
    </message>
    <message>
        <source>The last run on {} ended unexpectedly during {} recordings. Everything up to half a second before that is intact. Add the recordings to the session?</source>
        <translation>Die letzte Arbeit an {} endete unerwartet während {} Aufzeichnungen. Alles bis eine halbe Sekunde davor ist erhalten. Die Aufzeichnungen in die Sitzung übernehmen?</translation>
    </message>
    <message>
        <source>Add recordings</source>
        <translation>Aufzeichnungen übernehmen</translation>
    </message>
    <message>
        <source>Add recording</source>
        <translation>Aufzeichnung übernehmen</translation>
    </message>
    <message>
        <source>Leave them for later</source>
        <translation>Für später lassen</translation>
    </message>
    <message>
        <source>Leave it for later</source>
        <translation>Für später lassen</translation>
    </message>
    <message>
        <source>Choose another session</source>
        <translation>Andere Sitzung wählen</translation>
    </message>
    <message>
        <source>Adding recordings</source>
        <translation>Die Aufzeichnungen werden übernommen</translation>
    </message>
    <message>
        <source>Could not open the session: {}</source>
        <translation>Die Sitzung konnte nicht geöffnet werden: {}</translation>
    </message>
    <message>
        <source>Nothing is lost, and nothing can be added. All {} whole records are shown.</source>
        <translation>Nichts geht verloren, und nichts kann hinzukommen. Alle {} heilen Einträge sind zu sehen.</translation>
    </message>
    <message>
        <source>Open up to the damage</source>
        <translation>Bis zum Schaden öffnen</translation>
    </message>
    <message>
        <source>All {} whole records go into a new session; this one stays as it is. What is lost: at least {}.</source>
        <translation>Alle {} heilen Einträge kommen in eine neue Sitzung; diese bleibt, wie sie ist. Verloren geht mindestens: {}.</translation>
    </message>
    <message>
        <source>To be done again: {}.</source>
        <translation>Neu zu machen: {}.</translation>
    </message>
    <message>
        <source>Files: {}</source>
        <translation>Dateien: {}</translation>
    </message>
    <message>
        <source>The first {} records go on as this session; {} after them are set aside, and the journal as it was is kept beside.</source>
        <translation>Die ersten {} Einträge gehen als diese Sitzung weiter; {} danach werden beiseitegelegt, und das bisherige Journal bleibt daneben erhalten.</translation>
    </message>
    <message>
        <source>What is lost: {}.</source>
        <translation>Verloren geht: {}.</translation>
    </message>
    <message>
        <source>1 record</source>
        <translation>1 Eintrag</translation>
    </message>
    <message>
        <source>{} records</source>
        <translation>{} Einträge</translation>
    </message>
    <message>
        <source>Salvaging a copy of {}</source>
        <translation>Eine Kopie von {} wird gerettet</translation>
    </message>
    <message>
        <source>Looking at the damage of {}</source>
        <translation>Der Schaden von {} wird untersucht</translation>
    </message>
    <message>
        <source>Salvage a copy</source>
        <translation>Kopie retten</translation>
    </message>
    <message>
        <source>Open read-only</source>
        <translation>Schreibgeschützt öffnen</translation>
    </message>
    <message>
        <source>Try again</source>
        <translation>Erneut versuchen</translation>
    </message>
</context>
<context>
    <name>ShapePanel</name>
    <message>
        <source>Selected region</source>
        <translation>Die gewählte Region</translation>
    </message>
    <message>
        <source>Mirror the selected region</source>
        <translation>Gewählte Region spiegeln</translation>
    </message>
    <message>
        <source>Mirror</source>
        <translation>Spiegeln</translation>
    </message>
    <message>
        <source>Add the mirror image across the plane (M)</source>
        <translation>Das Spiegelbild an der Ebene hinzufügen (M)</translation>
    </message>
    <message>
        <source>Mirror plane</source>
        <translation>Spiegelebene</translation>
    </message>
    <message>
        <source>at {0} =</source>
        <translation>bei {0} =</translation>
    </message>
    <message>
        <source>Position of the mirror plane, mm in the sensor frame S</source>
        <translation>Lage der Spiegelebene, mm im Sensorsystem S</translation>
    </message>
    <message>
        <source>Distance to grow or shrink along the surface, mm</source>
        <translation>Strecke zum Vergrößern oder Verkleinern entlang der Oberfläche, mm</translation>
    </message>
    <message>
        <source>Rings: </source>
        <translation>Ringe: </translation>
    </message>
    <message>
        <source>Smoothing width in rings of facets</source>
        <translation>Breite der Glättung in Facettenringen</translation>
    </message>
    <message>
        <source>Removes details narrower than about this many facets</source>
        <translation>Entfernt Einzelheiten, die schmaler als etwa so viele Facetten sind</translation>
    </message>
    <message>
        <source>Grow</source>
        <translation>Vergrößern</translation>
    </message>
    <message>
        <source>Move the border outwards; other regions are unchanged</source>
        <translation>Den Rand nach außen schieben; andere Regionen bleiben unverändert</translation>
    </message>
    <message>
        <source>Shrink</source>
        <translation>Verkleinern</translation>
    </message>
    <message>
        <source>Move the border inwards</source>
        <translation>Den Rand nach innen schieben</translation>
    </message>
    <message>
        <source>Smooth</source>
        <translation>Glätten</translation>
    </message>
    <message>
        <source>Straighten the border, fill holes, remove specks</source>
        <translation>Rand begradigen, Löcher füllen, Flecken entfernen</translation>
    </message>
    <message>
        <source>Clear</source>
        <translation>Leeren</translation>
    </message>
    <message>
        <source>Remove all facets from the region</source>
        <translation>Alle Facetten aus der Region entfernen</translation>
    </message>
</context>
<context>
    <name>ShowDialog</name>
    <message>
        <source>Close</source>
        <translation>Schließen</translation>
    </message>
</context>
<context>
    <name>Shrinking</name>
    <message>
        <source>Contact error over poses</source>
        <translation>Kontaktfehler über den Posen</translation>
    </message>
</context>
<context>
    <name>Side</name>
    <message>
        <source>Displayed quantity</source>
        <translation>Gezeigte Größe</translation>
    </message>
    <message>
        <source>Value at the pointer</source>
        <translation>Wert am Zeiger</translation>
    </message>
    <message>
        <source>± 1 sigma. Density: from the number of touches.
Means: spread of the averaged values. Peak force: sensor noise.</source>
        <translation>± 1 Sigma. Dichte: aus der Zahl der Berührungen.
Mittelwerte: Streuung der gemittelten Werte. Größte Kraft: Rauschen des Sensors.</translation>
    </message>
    <message>
        <source>Nothing to show: {why}</source>
        <translation>Nichts zu zeigen: {why}</translation>
    </message>
    <message>
        <source>No contacts in this time window and force range. Widen one of them.</source>
        <translation>Keine Kontakte in diesem Zeitfenster und Kraftbereich. Erweitern Sie eines davon.</translation>
    </message>
    <message>
        <source>Touches: {count:,} of {all:,}; grey: no data</source>
        <translation>Berührungen: {count:,} von {all:,}; grau: keine Daten</translation>
    </message>
    <message>
        <source>Samples: {count:,} of {all:,}; grey: no data</source>
        <translation>Messwerte: {count:,} von {all:,}; grau: keine Daten</translation>
    </message>
    <message>
        <source>contact density</source>
        <translation>Kontaktdichte</translation>
    </message>
    <message>
        <source>mean force</source>
        <translation>mittlere Kraft</translation>
    </message>
    <message>
        <source>peak force</source>
        <translation>größte Kraft</translation>
    </message>
    <message>
        <source>mean error</source>
        <translation>mittlerer Fehler</translation>
    </message>
    <message>
        <source>uncertainty</source>
        <translation>Unsicherheit</translation>
    </message>
    <message>
        <source>point at the probe to read a value</source>
        <translation>zeigen Sie auf die Sonde, um einen Wert abzulesen</translation>
    </message>
    <message>
        <source>no data</source>
        <translation>keine Daten</translation>
    </message>
    <message>
        <source>at {x:.1f}, {y:.1f}, {z:.1f} mm</source>
        <translation>bei {x:.1f}, {y:.1f}, {z:.1f} mm</translation>
    </message>
</context>
<context>
    <name>StartPage</name>
    <message>
        <source>contactbench</source>
        <translation>contactbench</translation>
    </message>
    <message>
        <source>Calibrate a force/torque sensor behind a probe, prepare the probe mesh, verify contacts on the bench, and export a bundle.</source>
        <translation>Kalibrieren Sie einen Kraft-Momenten-Sensor hinter einer Sonde, bereiten Sie das Netz der Sonde vor, prüfen Sie Kontakte am Messplatz, und exportieren Sie ein Paket.</translation>
    </message>
    <message>
        <source>Recent sessions</source>
        <translation>Zuletzt benutzte Sitzungen</translation>
    </message>
    <message>
        <source>You can also drop a session folder on this window.</source>
        <translation>Sie können einen Sitzungsordner auch auf dieses Fenster ziehen.</translation>
    </message>
    <message>
        <source>Try the virtual bench</source>
        <translation>Virtuellen Messplatz ausprobieren</translation>
    </message>
    <message>
        <source>Simulated sensor, robot and probe; no hardware needed</source>
        <translation>Simulierter Sensor, Roboter und Sonde; keine Hardware nötig</translation>
    </message>
    <message>
        <source>New session</source>
        <translation>Neue Sitzung</translation>
    </message>
    <message>
        <source>Start with an empty folder for one sensor and one probe</source>
        <translation>Mit einem leeren Ordner für einen Sensor und eine Sonde beginnen</translation>
    </message>
    <message>
        <source>Open session</source>
        <translation>Sitzung öffnen</translation>
    </message>
    <message>
        <source>Open an existing session</source>
        <translation>Eine vorhandene Sitzung öffnen</translation>
    </message>
    <message>
        <source>missing: moved or deleted</source>
        <translation>fehlt: verschoben oder gelöscht</translation>
    </message>
    <message>
        <source>session</source>
        <translation>Sitzung</translation>
    </message>
</context>
<context>
    <name>StepList</name>
    <message>
        <source>Steps</source>
        <translation>Schritte</translation>
    </message>
    <message>
        <source>Devices</source>
        <translation>Geräte</translation>
    </message>
    <message>
        <source>Gravity</source>
        <translation>Schwerkraft</translation>
    </message>
    <message>
        <source>Probe</source>
        <translation>Sonde</translation>
    </message>
    <message>
        <source>Regions</source>
        <translation>Regionen</translation>
    </message>
    <message>
        <source>Verify</source>
        <translation>Prüfen</translation>
    </message>
    <message>
        <source>Export</source>
        <translation>Export</translation>
    </message>
</context>
<context>
    <name>StripChart</name>
    <message>
        <source>Force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>Torque</source>
        <translation>Moment</translation>
    </message>
    <message>
        <source>Force magnitude</source>
        <translation>Betrag der Kraft</translation>
    </message>
    <message>
        <source>Contact point</source>
        <translation>Kontaktpunkt</translation>
    </message>
    <message>
        <source>No measurements yet. Choose devices first.</source>
        <translation>Noch keine Messwerte. Wählen Sie zuerst Geräte.</translation>
    </message>
    <message>
        <source>Raw</source>
        <translation>Roh</translation>
    </message>
    <message>
        <source>Compensated</source>
        <translation>Kompensiert</translation>
    </message>
    <message>
        <source>Raw or compensated wrenches in the charts</source>
        <translation>Rohe oder kompensierte Messwerte in den Diagrammen</translation>
    </message>
    <message>
        <source>Raw: sensor readings. Compensated: bias and weight removed.</source>
        <translation>Roh: Messwerte des Sensors. Kompensiert: ohne Nullpunktfehler und Gewicht.</translation>
    </message>
    <message>
        <source>{seconds:g} s</source>
        <translation>{seconds:g} s</translation>
    </message>
    <message>
        <source>Time range of the charts</source>
        <translation>Zeitbereich der Diagramme</translation>
    </message>
    <message>
        <source>Time range in seconds</source>
        <translation>Zeitbereich in Sekunden</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Anhalten</translation>
    </message>
    <message>
        <source>Freeze the charts; recording continues</source>
        <translation>Die Diagramme einfrieren; die Aufzeichnung geht weiter</translation>
    </message>
    <message>
        <source>Resume live view</source>
        <translation>Zurück zur Live-Ansicht</translation>
    </message>
    <message>
        <source>Show current measurements</source>
        <translation>Aktuelle Messwerte zeigen</translation>
    </message>
    <message>
        <source>Charts shown</source>
        <translation>Diagramme</translation>
    </message>
    <message>
        <source>Choose which charts to show</source>
        <translation>Wählen, welche Diagramme gezeigt werden</translation>
    </message>
</context>
<context>
    <name>SurfaceSection</name>
    <message>
        <source>2  Outer surface</source>
        <translation>2  Außenfläche</translation>
    </message>
    <message>
        <source>Only if the mesh is open</source>
        <translation>Nur bei offenem Netz</translation>
    </message>
    <message>
        <source>Automatic</source>
        <translation>Automatisch</translation>
    </message>
    <message>
        <source>Smooth surface</source>
        <translation>Glatte Fläche</translation>
    </message>
    <message>
        <source>Straight lines</source>
        <translation>Gerade Linien</translation>
    </message>
    <message>
        <source>Hull of the rim</source>
        <translation>Hülle des Rands</translation>
    </message>
    <message>
        <source>Leave open</source>
        <translation>Offen lassen</translation>
    </message>
    <message>
        <source>Method for closing openings such as the cable outlet</source>
        <translation>Methode zum Schließen von Öffnungen, etwa für das Kabel</translation>
    </message>
    <message>
        <source>Close openings</source>
        <translation>Öffnungen schließen</translation>
    </message>
</context>
<context>
    <name>TimeBar</name>
    <message>
        <source>Time window</source>
        <translation>Zeitfenster</translation>
    </message>
    <message>
        <source>Time in seconds. Drag the handles or the bar between them; above the line: current time.
Keys: left and right; Space switches handles.</source>
        <translation>Zeit in Sekunden. Ziehen Sie die Griffe oder den Balken dazwischen; über der Linie: aktueller Zeitpunkt.
Tasten: links und rechts; Leertaste wechselt den Griff.</translation>
    </message>
    <message>
        <source>Show all</source>
        <translation>Alles zeigen</translation>
    </message>
    <message>
        <source>Stop and show the whole time window.</source>
        <translation>Anhalten und das ganze Zeitfenster zeigen.</translation>
    </message>
    <message>
        <source>{speed:g}x</source>
        <translation>{speed:g}x</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Tempo</translation>
    </message>
    <message>
        <source>Recorded seconds per second of playback.</source>
        <translation>Aufgezeichnete Sekunden pro Sekunde Wiedergabe.</translation>
    </message>
    <message>
        <source>keep touches</source>
        <translation>Berührungen behalten</translation>
    </message>
    <message>
        <source>last {seconds:g} s</source>
        <translation>letzte {seconds:g} s</translation>
    </message>
    <message>
        <source>Contacts shown during playback</source>
        <translation>Kontakte beim Abspielen</translation>
    </message>
    <message>
        <source>During playback: show all contacts from the start, or only the last seconds.</source>
        <translation>Beim Abspielen: alle Kontakte seit dem Beginn zeigen, oder nur die letzten Sekunden.</translation>
    </message>
    <message>
        <source>Pause</source>
        <translation>Anhalten</translation>
    </message>
    <message>
        <source>Play</source>
        <translation>Abspielen</translation>
    </message>
    <message>
        <source>{start:.1f} to {end:.1f} s of {whole:.1f} s</source>
        <translation>{start:.1f} bis {end:.1f} s von {whole:.1f} s</translation>
    </message>
</context>
<context>
    <name>ToolPanel</name>
    <message>
        <source>Protect other regions</source>
        <translation>Andere Regionen schützen</translation>
    </message>
    <message>
        <source>Facets of other regions are not changed</source>
        <translation>Facetten anderer Regionen werden nicht geändert</translation>
    </message>
    <message>
        <source>Now click the opposite corner.</source>
        <translation>Klicken Sie jetzt die gegenüberliegende Ecke an.</translation>
    </message>
    <message>
        <source>Each lower limit must be below the upper limit.</source>
        <translation>Jede untere Grenze muss kleiner sein als die obere.</translation>
    </message>
    <message>
        <source>Navigate</source>
        <translation>Navigieren</translation>
    </message>
    <message>
        <source>Rotate the view with the left button</source>
        <translation>Die Ansicht mit der linken Taste drehen</translation>
    </message>
    <message>
        <source>Brush</source>
        <translation>Pinsel</translation>
    </message>
    <message>
        <source>Paint the selected region</source>
        <translation>Die gewählte Region malen</translation>
    </message>
    <message>
        <source>Eraser</source>
        <translation>Radierer</translation>
    </message>
    <message>
        <source>Remove facets from their region</source>
        <translation>Facetten aus ihrer Region entfernen</translation>
    </message>
    <message>
        <source>Fill</source>
        <translation>Füllen</translation>
    </message>
    <message>
        <source>Fill up to sharp edges</source>
        <translation>Bis zu scharfen Kanten füllen</translation>
    </message>
    <message>
        <source>Box</source>
        <translation>Quader</translation>
    </message>
    <message>
        <source>Select everything between two corners</source>
        <translation>Alles zwischen zwei Ecken</translation>
    </message>
    <message>
        <source>Half</source>
        <translation>Hälfte</translation>
    </message>
    <message>
        <source>Select everything on one side of a plane</source>
        <translation>Alles auf einer Seite einer Ebene</translation>
    </message>
    <message>
        <source>{0} (regions)</source>
        <translation>{0} (Regionen)</translation>
    </message>
    <message>
        <source>Choose a tool. The right button always rotates the view.</source>
        <translation>Wählen Sie ein Werkzeug. Die rechte Taste dreht immer die Ansicht.</translation>
    </message>
    <message>
        <source>Radius</source>
        <translation>Radius</translation>
    </message>
    <message>
        <source>Brush radius</source>
        <translation>Radius des Pinsels</translation>
    </message>
    <message>
        <source>[ and ], or Ctrl + wheel</source>
        <translation>[ und ], oder Strg + Mausrad</translation>
    </message>
    <message>
        <source>Brush radius, mm</source>
        <translation>Radius des Pinsels, mm</translation>
    </message>
    <message>
        <source>Drag over the probe. Shift erases. Esc cancels the stroke.</source>
        <translation>Über die Sonde ziehen. Umschalt radiert. Esc bricht den Strich ab.</translation>
    </message>
    <message>
        <source>Edge limit</source>
        <translation>Kantengrenze</translation>
    </message>
    <message>
        <source>Sharpest edge to cross</source>
        <translation>Schärfste überschrittene Kante</translation>
    </message>
    <message>
        <source>Sharpest edge to cross, degrees</source>
        <translation>Schärfste überschrittene Kante, Grad</translation>
    </message>
    <message>
        <source>The fill stops at edges sharper than this, degrees</source>
        <translation>Das Füllen endet an schärferen Kanten, Grad</translation>
    </message>
    <message>
        <source>Remove instead</source>
        <translation>Stattdessen entfernen</translation>
    </message>
    <message>
        <source>Click the probe to fill up to the nearest sharp edges.</source>
        <translation>Auf die Sonde klicken, um bis zu den nächsten scharfen Kanten zu füllen.</translation>
    </message>
    <message>
        <source>low</source>
        <translation>unten</translation>
    </message>
    <message>
        <source>high</source>
        <translation>oben</translation>
    </message>
    <message>
        <source>{0} {1}, mm in the sensor frame S</source>
        <translation>{0} {1}, mm im Sensorsystem S</translation>
    </message>
    <message>
        <source>Click the probe to move the plane there, or enter a number.</source>
        <translation>Auf die Sonde klicken, um die Ebene dorthin zu legen, oder die Zahl eingeben.</translation>
    </message>
    <message>
        <source>Side of the plane</source>
        <translation>Welche Seite der Ebene</translation>
    </message>
    <message>
        <source>above {0}</source>
        <translation>über {0}</translation>
    </message>
    <message>
        <source>below {0}</source>
        <translation>unter {0}</translation>
    </message>
    <message>
        <source>Position of the plane, mm in the sensor frame S</source>
        <translation>Lage der Ebene, mm im Sensorsystem S</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Remove facets</source>
        <translation>Facetten entfernen</translation>
    </message>
    <message>
        <source>Remove these facets from the selected region</source>
        <translation>Diese Facetten aus der gewählten Region entfernen</translation>
    </message>
    <message>
        <source>Add these facets to the selected region</source>
        <translation>Diese Facetten zur gewählten Region hinzufügen</translation>
    </message>
    <message>
        <source>Click two opposite corners on the probe, or enter the numbers.</source>
        <translation>Zwei gegenüberliegende Ecken auf der Sonde anklicken, oder die Zahlen eingeben.</translation>
    </message>
</context>
<context>
    <name>TouchPanel</name>
    <message>
        <source>Touch again</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>Repeat the marker selected in the table, or the last one; all its touches count</source>
        <translation>Den in der Tabelle gewählten Marker wiederholen, sonst den letzten; alle seine Berührungen zählen</translation>
    </message>
    <message>
        <source>Skip marker</source>
        <translation>Marker auslassen</translation>
    </message>
    <message>
        <source>Skip the next marker and enter the reason, which appears in the report</source>
        <translation>Den nächsten Marker auslassen und den Grund eingeben; er erscheint im Bericht</translation>
    </message>
    <message>
        <source>Touch all</source>
        <translation>Alle berühren</translation>
    </message>
    <message>
        <source>The virtual bench presses all markers in turn</source>
        <translation>Der virtuelle Messplatz drückt nacheinander auf alle Marker</translation>
    </message>
    <message>
        <source>Contact heatmap</source>
        <translation>Kontakt-Heatmap</translation>
    </message>
    <message>
        <source>Colour the probe by contact density, in contacts per mm²</source>
        <translation>Die Sonde nach Kontaktdichte färben, in Kontakten pro mm²</translation>
    </message>
    <message>
        <source>Within: 95 of 100 touches lie no farther from the point shown, by its covariance (2.45 times the largest standard deviation)</source>
        <translation>Auf: 95 von 100 Berührungen liegen laut Kovarianz nicht weiter vom gezeigten Punkt entfernt (2,45-mal die größte Standardabweichung)</translation>
    </message>
    <message>
        <source>Mute tones</source>
        <translation>Töne stumm schalten</translation>
    </message>
    <message>
        <source>Each state has its own tone; press to mute</source>
        <translation>Jeder Zustand hat einen eigenen Ton; drücken zum Stummschalten</translation>
    </message>
    <message>
        <source>Stop without a verdict; the touches are discarded</source>
        <translation>Ohne Ergebnis beenden; die Berührungen werden verworfen</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>Verwerfen</translation>
    </message>
    <message>
        <source>Tones muted</source>
        <translation>Töne stumm</translation>
    </message>
    <message>
        <source>Skip {name}</source>
        <translation>{name} auslassen</translation>
    </message>
    <message>
        <source>Reason for skipping {name} (appears in the report)</source>
        <translation>Grund für das Auslassen von {name} (erscheint im Bericht)</translation>
    </message>
    <message>
        <source>not reachable</source>
        <translation>nicht erreichbar</translation>
    </message>
    <message>
        <source>mark no longer visible</source>
        <translation>Markierung nicht mehr sichtbar</translation>
    </message>
    <message>
        <source>housing is too soft there</source>
        <translation>Gehäuse dort zu weich</translation>
    </message>
    <message>
        <source>a touch could cause damage</source>
        <translation>eine Berührung könnte Schaden anrichten</translation>
    </message>
    <message>
        <source>{name} was not skipped: enter a reason.</source>
        <translation>{name} wurde nicht ausgelassen: Geben Sie einen Grund an.</translation>
    </message>
    <message>
        <source>{name} was not skipped because it has been touched in the meantime.</source>
        <translation>{name} wurde nicht ausgelassen, weil der Marker inzwischen berührt wurde.</translation>
    </message>
    <message>
        <source>{name} skipped: {why}. The verdict and the report state the reason.</source>
        <translation>{name} ausgelassen: {why}. Ergebnis und Bericht nennen den Grund.</translation>
    </message>
    <message>
        <source>second touch</source>
        <translation>zweite Berührung</translation>
    </message>
    <message>
        <source>second touch, behind</source>
        <translation>zweite Berührung, dahinter</translation>
    </message>
    <message>
        <source>possible alternative</source>
        <translation>mögliche Alternative</translation>
    </message>
    <message>
        <source>possible alternative, behind</source>
        <translation>mögliche Alternative, dahinter</translation>
    </message>
    <message>
        <source>No sensor is open. Connect one in step 1, Devices.</source>
        <translation>Kein Sensor ist geöffnet. Verbinden Sie einen in Schritt 1, Geräte.</translation>
    </message>
    <message>
        <source>Place markers on the first tab.</source>
        <translation>Setzen Sie zuerst Marker auf dem ersten Reiter.</translation>
    </message>
    <message>
        <source>Remove everything from the probe, then start. After that, just touch the markers; no mouse is needed.</source>
        <translation>Nehmen Sie alles von der Sonde weg und starten Sie. Danach berühren Sie nur noch die Marker; eine Maus ist nicht nötig.</translation>
    </message>
    <message>
        <source>Press with {low} to {high} N and hold still.</source>
        <translation>Mit {low} bis {high} N drücken und still halten.</translation>
    </message>
    <message>
        <source>Adjust the force to {low}–{high} N and hold still.</source>
        <translation>Die Kraft auf {low}–{high} N bringen und still halten.</translation>
    </message>
    <message>
        <source>Keep still: measuring.</source>
        <translation>Still halten: Es wird gemessen.</translation>
    </message>
    <message>
        <source>Release.</source>
        <translation>Loslassen.</translation>
    </message>
    <message>
        <source>{why} ({force} N). Release, then touch again.</source>
        <translation>{why} ({force} N). Loslassen und noch einmal berühren.</translation>
    </message>
    <message>
        <source>{marker}: error {size} mm.</source>
        <translation>{marker}: Fehler {size} mm.</translation>
    </message>
    <message>
        <source>{marker}: error {size} mm. Release.</source>
        <translation>{marker}: Fehler {size} mm. Loslassen.</translation>
    </message>
    <message>
        <source>Sure, within {near} mm</source>
        <translation>Sicher, auf {near} mm genau</translation>
    </message>
    <message>
        <source>Sure by the defined regions, within {near} mm</source>
        <translation>Sicher dank der festgelegten Regionen, auf {near} mm genau</translation>
    </message>
    <message>
        <source>Only within {near} mm. Press harder, or more directly into the surface.</source>
        <translation>Nur auf {near} mm genau. Drücken Sie stärker oder senkrechter auf die Oberfläche.</translation>
    </message>
    <message>
        <source>Confidence {percent} %: the wrench also fits another place. Press in a different direction.</source>
        <translation>Sicherheit {percent} %: Der Messwert passt auch zu einer anderen Stelle. Drücken Sie in eine andere Richtung.</translation>
    </message>
    <message>
        <source>Two touches detected; both are shown.</source>
        <translation>Zwei Berührungen erkannt; beide werden gezeigt.</translation>
    </message>
    <message>
        <source>No single touch explains this wrench (residual {sigmas} sigma, moment arm {arm} mm). Check for two simultaneous touches, and check units, mount and compensation.</source>
        <translation>Keine einzelne Berührung erklärt diesen Messwert (Abweichung {sigmas} Sigma, Hebelarm {arm} mm). Prüfen Sie, ob zwei Berührungen gleichzeitig auftreten, und prüfen Sie Einheiten, Montage und Kompensation.</translation>
    </message>
    <message>
        <source>The force is almost parallel to the surface. Press more directly into it.</source>
        <translation>Die Kraft ist fast parallel zur Oberfläche. Drücken Sie steiler.</translation>
    </message>
    <message>
        <source>The contact is outside all regions.</source>
        <translation>Der Kontakt liegt außerhalb aller Regionen.</translation>
    </message>
    <message>
        <source>The sensor is at the limit of its range. Press less hard.</source>
        <translation>Der Sensor ist an der Grenze seines Messbereichs. Drücken Sie weniger fest.</translation>
    </message>
    <message>
        <source>No part of the probe faces this force. Check the force sign and the mount.</source>
        <translation>Kein Teil der Sonde ist dieser Kraft zugewandt. Prüfen Sie das Vorzeichen der Kraft und die Montage.</translation>
    </message>
    <message>
        <source>Torsion arm {arm} mm, learned for {seconds} s.</source>
        <translation>Torsionsarm {arm} mm, seit {seconds} s gelernt.</translation>
    </message>
    <message>
        <source>On a facet added during repair: its position is an estimate.</source>
        <translation>Auf einer bei der Reparatur ergänzten Facette: Ihre Lage ist geschätzt.</translation>
    </message>
    <message>
        <source>On an untouchable region: check the region and the mount.</source>
        <translation>Auf einer nicht berührbaren Region: Prüfen Sie die Region und die Montage.</translation>
    </message>
    <message>
        <source>All markers touched ({done} touches). Finish, or repeat any marker.</source>
        <translation>Alle Marker berührt ({done} Berührungen). Beenden Sie, oder wiederholen Sie Marker.</translation>
    </message>
    <message>
        <source>Next: {name} · {done} of {wanted} touches</source>
        <translation>Als Nächstes: {name} · {done} von {wanted} Berührungen</translation>
    </message>
    <message>
        <source>of accepted touches</source>
        <translation>der gezählten Berührungen</translation>
    </message>
    <message>
        <source>largest {largest} mm; last: {ratio} times the expected noise</source>
        <translation>größter {largest} mm; letzter: das {ratio}-Fache des erwarteten Rauschens</translation>
    </message>
</context>
<context>
    <name>TouchState</name>
    <message>
        <source>Touch state: {word}. {detail}</source>
        <translation>Zustand der Berührung: {word}. {detail}</translation>
    </message>
    <message>
        <source>{force} N</source>
        <translation>{force} N</translation>
    </message>
</context>
<context>
    <name>Toucher</name>
    <message>
        <source>{name} was pressed {count} times without an accepted touch ({why}). Press Skip marker, then Touch all again. Or discard the touches and move the marker.</source>
        <translation>{name} wurde {count}-mal gedrückt, ohne dass eine Berührung zählte ({why}). Drücken Sie „Marker auslassen“ und dann wieder „Alle berühren“. Oder verwerfen Sie die Berührungen und verschieben Sie den Marker.</translation>
    </message>
    <message>
        <source>no touch was detected</source>
        <translation>es wurde keine Berührung erkannt</translation>
    </message>
</context>
<context>
    <name>TradeoffChart</name>
    <message>
        <source>facets</source>
        <translation>Facetten</translation>
    </message>
    <message>
        <source>solve time, µs</source>
        <translation>Rechenzeit einer Lösung, µs</translation>
    </message>
    <message>
        <source>plain loop time, µs</source>
        <translation>Rechenzeit der einfachen Schleife, µs</translation>
    </message>
    <message>
        <source>Horizontal axis</source>
        <translation>Waagerechte Achse</translation>
    </message>
    <message>
        <source>Horizontal axis: facets, or µs per solve</source>
        <translation>Waagerechte Achse: Facetten, oder µs je Lösung</translation>
    </message>
    <message>
        <source>Error, mm, against</source>
        <translation>Fehler, mm, über</translation>
    </message>
    <message>
        <source>95th percentile of the contact shift relative to the full mesh, mm</source>
        <translation>95. Perzentil der Kontaktverschiebung gegenüber dem vollen Netz, mm</translation>
    </message>
    <message>
        <source>Contact error against facet count</source>
        <translation>Kontaktfehler über der Facettenzahl</translation>
    </message>
    <message>
        <source>limit {:.2g} mm</source>
        <translation>Grenze {:.2g} mm</translation>
    </message>
    <message>
        <source>knee</source>
        <translation>Knick</translation>
    </message>
    <message>
        <source>Choose a point with a click or the arrow keys.</source>
        <translation>Wählen Sie einen Punkt: mit einem Klick oder den Pfeiltasten.</translation>
    </message>
    <message>
        <source>{:,} facets: contacts shift by up to {:.2g} mm; one solve takes {:.2g} µs.</source>
        <translation>{:,} Facetten: Kontakte verschieben sich um bis zu {:.2g} mm; eine Lösung dauert {:.2g} µs.</translation>
    </message>
</context>
<context>
    <name>TroubleWatch</name>
    <message>
        <source>Checking session files</source>
        <translation>Sitzungsdateien werden geprüft</translation>
    </message>
    <message>
        <source>The disk is writable again and the session continues. Repeat the actions that were refused; earlier recordings are intact.</source>
        <translation>Der Datenträger ist wieder beschreibbar und die Sitzung geht weiter. Wiederholen Sie die abgelehnten Aktionen; frühere Aufzeichnungen sind unversehrt.</translation>
    </message>
    <message>
        <source>The sensor is back and sending readings.</source>
        <translation>Der Sensor ist wieder da und sendet Messwerte.</translation>
    </message>
    <message>
        <source>A file in this session has changed since it was written. Results that depend on it are invalid.</source>
        <translation>Eine Datei dieser Sitzung wurde nachträglich verändert. Ergebnisse, die darauf beruhen, sind ungültig.</translation>
    </message>
    <message>
        <source>{} files in this session have changed since they were written. Results that depend on them are invalid.</source>
        <translation>{} Dateien dieser Sitzung wurden nachträglich verändert. Ergebnisse, die darauf beruhen, sind ungültig.</translation>
    </message>
    <message>
        <source>All files of this session are as they were written again.</source>
        <translation>Alle Dateien dieser Sitzung sind wieder so, wie sie geschrieben wurden.</translation>
    </message>
</context>
<context>
    <name>VerifyPage</name>
    <message>
        <source>Markers</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>Settings</source>
        <translation>Regeln</translation>
    </message>
    <message>
        <source>Point</source>
        <translation>Punkt</translation>
    </message>
    <message>
        <source>Touch</source>
        <translation>Berühren</translation>
    </message>
    <message>
        <source>Result</source>
        <translation>Urteil</translation>
    </message>
    <message>
        <source>Drawing heatmap</source>
        <translation>Die Heatmap wird gezeichnet</translation>
    </message>
    <message>
        <source>{mean} mm</source>
        <translation>{mean} mm</translation>
    </message>
    <message>
        <source>error at {}</source>
        <translation>Fehler an {}</translation>
    </message>
    <message>
        <source>Saving recording</source>
        <translation>Die Aufzeichnung wird gesichert</translation>
    </message>
    <message>
        <source>Loading verification</source>
        <translation>Die Überprüfung wird geladen</translation>
    </message>
    <message>
        <source>Loading probe</source>
        <translation>Die Sonde wird geladen</translation>
    </message>
    <message>
        <source>Measuring noise</source>
        <translation>Das Rauschen wird gemessen</translation>
    </message>
    <message>
        <source>verify</source>
        <translation>prüfen</translation>
    </message>
    <message>
        <source>Verification passed.</source>
        <translation>Die Überprüfung ist bestanden.</translation>
    </message>
    <message>
        <source>Verification failed.</source>
        <translation>Die Überprüfung ist nicht bestanden.</translation>
    </message>
    <message>
        <source>Evaluating touches</source>
        <translation>Die Berührungen werden ausgewertet</translation>
    </message>
    <message>
        <source>Stopping recording</source>
        <translation>Die Aufzeichnung wird beendet</translation>
    </message>
    <message>
        <source>Start touching</source>
        <translation>Berühren beginnen</translation>
    </message>
    <message>
        <source>Verify again</source>
        <translation>Erneut prüfen</translation>
    </message>
    <message>
        <source>Go to Gravity</source>
        <translation>Zur Schwerkraft</translation>
    </message>
    <message>
        <source>Open Probe</source>
        <translation>Sonde öffnen</translation>
    </message>
    <message>
        <source>Save the recording, evaluate it and create the report</source>
        <translation>Die Aufzeichnung speichern, auswerten und den Bericht erstellen</translation>
    </message>
    <message>
        <source>Touch {}</source>
        <translation>{} berühren</translation>
    </message>
    <message>
        <source>Finish</source>
        <translation>Beenden</translation>
    </message>
    <message>
        <source>Place {} markers</source>
        <translation>{} Marker setzen</translation>
    </message>
    <message>
        <source>Next: Export</source>
        <translation>Weiter: Export</translation>
    </message>
</context>
<context>
    <name>VerifySettingsPanel</name>
    <message>
        <source>Lower force limit, N</source>
        <translation>Untere Kraftgrenze, N</translation>
    </message>
    <message>
        <source>Upper force limit, N</source>
        <translation>Obere Kraftgrenze, N</translation>
    </message>
    <message>
        <source>any order</source>
        <translation>beliebig</translation>
    </message>
    <message>
        <source>table order</source>
        <translation>wie in der Tabelle</translation>
    </message>
    <message>
        <source>Order in which to touch the markers</source>
        <translation>Reihenfolge, in der die Marker berührt werden</translation>
    </message>
    <message>
        <source>Any order: a touch counts for the nearest marker. Table order: it counts for the next marker.</source>
        <translation>Beliebig: Eine Berührung zählt für den nächstgelegenen Marker. Wie in der Tabelle: Sie zählt für den nächsten Marker der Reihe.</translation>
    </message>
    <message>
        <source>as calibrated</source>
        <translation>wie kalibriert</translation>
    </message>
    <message>
        <source>follows</source>
        <translation>folgt</translation>
    </message>
    <message>
        <source>The sensor&apos;s zero</source>
        <translation>Nullpunkt des Sensors</translation>
    </message>
    <message>
        <source>Follows: what the sensor reads between touches is subtracted, here and in the runtime. Lift the probe clear for half a second before each touch.</source>
        <translation>Folgt: Was der Sensor zwischen den Berührungen anzeigt, wird abgezogen, hier und zur Laufzeit. Die Sonde vor jeder Berührung eine halbe Sekunde frei anheben.</translation>
    </message>
    <message>
        <source>Press with</source>
        <translation>Drücken mit</translation>
    </message>
    <message>
        <source>to</source>
        <translation>bis</translation>
    </message>
    <message>
        <source>Touch order</source>
        <translation>Reihenfolge</translation>
    </message>
    <message>
        <source>Zero</source>
        <translation>Nullpunkt</translation>
    </message>
    <message>
        <source>Order of touches</source>
        <translation>Reihenfolge der Berührungen</translation>
    </message>
    <message>
        <source>Force window</source>
        <translation>Kraftfenster</translation>
    </message>
</context>
<context>
    <name>ViewButtons</name>
    <message>
        <source>Front</source>
        <translation>Vorn</translation>
    </message>
    <message>
        <source>View from the front: x right, z up</source>
        <translation>Von vorn ansehen: x nach rechts, z nach oben</translation>
    </message>
    <message>
        <source>Side</source>
        <translation>Seite</translation>
    </message>
    <message>
        <source>View from the side: y right, z up</source>
        <translation>Von der Seite ansehen: y nach rechts, z nach oben</translation>
    </message>
    <message>
        <source>Top</source>
        <translation>Oben</translation>
    </message>
    <message>
        <source>View the tip from above: x right, y up</source>
        <translation>Von oben auf die Spitze sehen: x nach rechts, y nach oben</translation>
    </message>
    <message>
        <source>Fit</source>
        <translation>Einpassen</translation>
    </message>
    <message>
        <source>Show the whole probe from the same direction</source>
        <translation>Die ganze Sonde aus derselben Richtung zeigen</translation>
    </message>
    <message>
        <source>Perspective</source>
        <translation>Perspektive</translation>
    </message>
    <message>
        <source>Nearer objects look larger, so no scale bar is shown</source>
        <translation>Nähere Teile wirken größer; deshalb wird kein Maßstab gezeigt</translation>
    </message>
    <message>
        <source>View</source>
        <translation>Ansicht</translation>
    </message>
    <message>
        <source>How the probe is viewed</source>
        <translation>Wie die Sonde betrachtet wird</translation>
    </message>
</context>
<context>
    <name>ViewerWork</name>
    <message>
        <source>Stopped; nothing was changed.</source>
        <translation>Angehalten; nichts wurde geändert.</translation>
    </message>
    <message>
        <source>Unexpected error: {what}.</source>
        <translation>Unerwarteter Fehler: {what}.</translation>
    </message>
</context>
<context>
    <name>WeightPanel</name>
    <message>
        <source>Known weight</source>
        <translation>Bekanntes Gewicht</translation>
    </message>
    <message>
        <source>Hang a known mass on the tool. This reveals wrong sensor units, signs or scale, which poses alone cannot show.</source>
        <translation>Hängen Sie eine bekannte Masse an das Werkzeug. So zeigen sich falsche Einheiten, Vorzeichen oder Skalen des Sensors, die Posen allein nicht zeigen können.</translation>
    </message>
    <message>
        <source>Mass</source>
        <translation>Masse</translation>
    </message>
    <message>
        <source>Uncertainty (1 sigma)</source>
        <translation>Unsicherheit (1 Sigma)</translation>
    </message>
    <message>
        <source>Number (optional)</source>
        <translation>Nummer (optional)</translation>
    </message>
    <message>
        <source>Certificate</source>
        <translation>Zertifikat</translation>
    </message>
    <message>
        <source>1. Read without weight</source>
        <translation>1. Ohne Gewicht messen</translation>
    </message>
    <message>
        <source>2. Read with weight</source>
        <translation>2. Mit Gewicht messen</translation>
    </message>
    <message>
        <source>Remove everything from the tool and hold it still.</source>
        <translation>Alles vom Werkzeug nehmen und es still halten.</translation>
    </message>
    <message>
        <source>Done. Hang the weight on the tool, wait until it is at rest, then press 2.</source>
        <translation>Fertig. Hängen Sie das Gewicht an das Werkzeug, warten Sie, bis es ruht, und drücken Sie dann 2.</translation>
    </message>
    <message>
        <source>Wait until the weight is at rest.</source>
        <translation>Warten, bis das Gewicht ruht.</translation>
    </message>
</context>
<context>
    <name>_Face</name>
    <message>
        <source>{force} N</source>
        <translation>{force} N</translation>
    </message>
</context>
<context>
    <name>_Missing</name>
    <message>
        <source>This page could not be created. See Messages for details. The other steps still work.</source>
        <translation>Diese Seite konnte nicht erstellt werden. Einzelheiten stehen unter Meldungen. Die anderen Schritte funktionieren weiter.</translation>
    </message>
</context>
<context>
    <name>pipeline</name>
    <message>
        <source> (and would not show in the residuals)</source>
        <translation> (und wäre in den Restabweichungen nicht zu sehen)</translation>
    </message>
    <message>
        <source> (from a file: load_probe with units=&apos;mm&apos;)</source>
        <translation> (aus einer Datei: load_probe mit units=&apos;mm&apos;)</translation>
    </message>
    <message>
        <source> (or the sensor was re-zeroed after it)</source>
        <translation> (oder der Sensor wurde danach neu genullt)</translation>
    </message>
    <message>
        <source> (or the sensor was re-zeroed before it)</source>
        <translation> (oder der Sensor wurde davor neu genullt)</translation>
    </message>
    <message>
        <source> ({0} of the {1} parts entirely)</source>
        <translation> ({0} der {1} Teile ganz)</translation>
    </message>
    <message>
        <source> A steady touch cannot be detected before the first calibration.</source>
        <translation> Eine stetige Berührung ist vor einer ersten Kalibrierung nicht zu erkennen.</translation>
    </message>
    <message>
        <source> A steady touch cannot be detected without the orientation.</source>
        <translation> Eine stetige Berührung ist ohne die Orientierung nicht zu erkennen.</translation>
    </message>
    <message>
        <source> Allow more time, or start with fewer facets.</source>
        <translation> Mehr Zeit geben oder mit weniger Facetten beginnen.</translation>
    </message>
    <message>
        <source> Another one is in preparation: use it, or undo it.</source>
        <translation> Eine andere wird vorbereitet: Verwenden Sie sie, oder nehmen Sie das zurück.</translation>
    </message>
    <message>
        <source> Correct that, or export it as unverified, for trials without a person.</source>
        <translation> Beheben Sie das; oder exportieren Sie sie als ungeprüft, für Versuche ohne Menschen.</translation>
    </message>
    <message>
        <source> Equally many fit if {0}.</source>
        <translation> Ebenso viele passen, wenn {0}.</translation>
    </message>
    <message>
        <source> If these are inner walls, contacts can be placed on them.</source>
        <translation> Wo das Innenwände sind, können Kontakte dorthin gelegt werden.</translation>
    </message>
    <message>
        <source> It has joints: name their robot with --robot NAME.</source>
        <translation> Es gibt Gelenke: Nennen Sie ihren Roboter mit --robot NAME.</translation>
    </message>
    <message>
        <source> It is usable, but not good.</source>
        <translation> Sie ist brauchbar, aber nicht gut.</translation>
    </message>
    <message>
        <source> It looks transposed.</source>
        <translation> Sie sieht transponiert aus.</translation>
    </message>
    <message>
        <source> It was made by {0}, this is {1}.</source>
        <translation> Gemacht von {0}, dies ist {1}.</translation>
    </message>
    <message>
        <source> Its orientation is unknown, so gravity cannot be calibrated.</source>
        <translation> Seine Orientierung ist unbekannt, deshalb kann die Schwerkraft nicht kalibriert werden.</translation>
    </message>
    <message>
        <source> Last output: {0}.</source>
        <translation> Letzte Ausgabe: {0}.</translation>
    </message>
    <message>
        <source> Repair the mesh first, or use another engine.</source>
        <translation> Reparieren Sie zuerst das Netz oder verwenden Sie ein anderes Werkzeug.</translation>
    </message>
    <message>
        <source> Simplify the mesh, or export it with a limit on the aspect ratio.</source>
        <translation> Vereinfachen Sie das Netz, oder exportieren Sie mit einer Grenze für das Seitenverhältnis.</translation>
    </message>
    <message>
        <source> The file declares several units: {0}.</source>
        <translation> Die Datei nennt mehrere Einheiten: {0}.</translation>
    </message>
    <message>
        <source> The unexplained scatter is {0} times the expected noise.</source>
        <translation> Die unerklärte Streuung ist das {0}-Fache des erwarteten Rauschens.</translation>
    </message>
    <message>
        <source> The usual causes are facets without area, duplicates and holes.</source>
        <translation> Die üblichen Ursachen sind Facetten ohne Fläche, Duplikate und Löcher.</translation>
    </message>
    <message>
        <source> Without the left-out touches these are {0} and {1} mm rms.</source>
        <translation> Ohne die ausgelassenen Berührungen sind es {0} und {1} mm rms.</translation>
    </message>
    <message>
        <source> and </source>
        <translation> und </translation>
    </message>
    <message>
        <source> and a volume of {0} cm³.</source>
        <translation> und einem Volumen von {0} cm³.</translation>
    </message>
    <message>
        <source> and as </source>
        <translation> und als </translation>
    </message>
    <message>
        <source> and {0} more</source>
        <translation> und {0} weitere</translation>
    </message>
    <message>
        <source> its messages name the joints {0}, but have no angles.</source>
        <translation> Seine Nachrichten nennen die Gelenke {0}, enthalten aber keine Winkel.</translation>
    </message>
    <message>
        <source> of {0} facets</source>
        <translation> mit {0} Facetten</translation>
    </message>
    <message>
        <source> or </source>
        <translation> oder </translation>
    </message>
    <message>
        <source> or if </source>
        <translation> oder wenn </translation>
    </message>
    <message>
        <source>, with the outlines of the regions kept</source>
        <translation>, welche die Umrisse der Regionen bewahrt</translation>
    </message>
    <message>
        <source> the robot has the joints {0}, the messages {1}.</source>
        <translation> Der Roboter hat die Gelenke {0}, die Nachrichten {1}.</translation>
    </message>
    <message>
        <source> together with </source>
        <translation> zusammen mit </translation>
    </message>
    <message>
        <source> {0} to {1} s: {2}</source>
        <translation> {0} bis {1} s: {2}</translation>
    </message>
    <message>
        <source> {0} wrenches and {1} flange poses.</source>
        <translation> {0} Kraft-Momenten-Messwerten und {1} Posen des Flansches.</translation>
    </message>
    <message>
        <source> {0}, but {1}.</source>
        <translation> {0}, aber {1}.</translation>
    </message>
    <message>
        <source>% of a channel&apos;s load: crosstalk into the others.</source>
        <translation>% der Last eines Kanals: Übersprechen in die anderen.</translation>
    </message>
    <message>
        <source>% of a load: added to the reading after the load has stayed for minutes.</source>
        <translation>% einer Last: was zusätzlich angezeigt wird, wenn sie Minuten bleibt.</translation>
    </message>
    <message>
        <source>% of full scale: width of the loop between loading and unloading.</source>
        <translation>% des Messbereichs: Breite der Schleife zwischen Be- und Entlasten.</translation>
    </message>
    <message>
        <source>% of the largest load so far: the same, growing with it.</source>
        <translation>% der bisher größten Last: dasselbe, mit ihr wachsend.</translation>
    </message>
    <message>
        <source>&apos;#&apos;: write it as %23 if it belongs to the path</source>
        <translation>&apos;#&apos;: als %23 schreiben, wo es zum Pfad gehört</translation>
    </message>
    <message>
        <source>&apos;history&apos; is not a list of at most {0} steps: correct it, or remove the key.</source>
        <translation>&apos;history&apos; ist keine Liste von höchstens {0} Schritten: Berichtigen Sie das, oder entfernen Sie den Schlüssel.</translation>
    </message>
    <message>
        <source>&apos;mesh&apos; does not say whether the frame is P or S: correct it, or remove the key.</source>
        <translation>&apos;mesh&apos; sagt nicht, ob das System P oder S ist: Berichtigen Sie das, oder entfernen Sie den Schlüssel.</translation>
    </message>
    <message>
        <source>&apos;regions&apos; is not a list of names and colours: correct it, or remove the key.</source>
        <translation>&apos;regions&apos; ist keine Liste von Namen und Farben: Berichtigen Sie das, oder entfernen Sie den Schlüssel.</translation>
    </message>
    <message>
        <source>(no name)</source>
        <translation>(kein Name)</translation>
    </message>
    <message>
        <source>(not given)</source>
        <translation>(nicht angegeben)</translation>
    </message>
    <message>
        <source>({0}) degrees as a rotation vector</source>
        <translation>({0}) Grad als Rotationsvektor</translation>
    </message>
    <message>
        <source>, an unusual size</source>
        <translation>, eine ungewöhnliche Größe</translation>
    </message>
    <message>
        <source>, and </source>
        <translation>, und </translation>
    </message>
    <message>
        <source>, and also turn it about the vertical</source>
        <translation>, und drehen Sie es auch um die Senkrechte</translation>
    </message>
    <message>
        <source>, and no / in front, which tf2 refuses</source>
        <translation>, und vorn kein /, denn das lehnt tf2 ab</translation>
    </message>
    <message>
        <source>, and others</source>
        <translation>, und andere</translation>
    </message>
    <message>
        <source>, and the total error changes by {0} %</source>
        <translation>, und der gesamte Fehler ändert sich um {0} %</translation>
    </message>
    <message>
        <source>, and {0} more such pairs</source>
        <translation>, und {0} weitere solche Paare</translation>
    </message>
    <message>
        <source>, as with a sensor that reports the reaction</source>
        <translation>, wie bei einem Sensor, der die Gegenkraft ausgibt</translation>
    </message>
    <message>
        <source>, lead slowed to {0}/s</source>
        <translation>, Vorhalt verlangsamt auf {0}/s</translation>
    </message>
    <message>
        <source>, none starting with a digit</source>
        <translation>, von denen keiner mit einer Ziffer beginnt</translation>
    </message>
    <message>
        <source>, optionally also {0}</source>
        <translation>, wahlweise auch {0}</translation>
    </message>
    <message>
        <source>, or rename these columns to use qw, qx, qy, qz</source>
        <translation>, oder benennen Sie diese Spalten um, um qw, qx, qy, qz zu nutzen</translation>
    </message>
    <message>
        <source>, or the mass of the tool as weighed</source>
        <translation>, oder die gewogene Masse des Werkzeugs</translation>
    </message>
    <message>
        <source>, weighed by confidence</source>
        <translation>, nach Sicherheit gewichtet</translation>
    </message>
    <message>
        <source>, {0} N and {1} mN·m per hour at the end</source>
        <translation>, am Ende {0} N und {1} mN·m pro Stunde</translation>
    </message>
    <message>
        <source>, {0} among them</source>
        <translation>, darunter {0}</translation>
    </message>
    <message>
        <source>, {0} left out</source>
        <translation>, ausgelassen: {0}</translation>
    </message>
    <message>
        <source>, {0} of the noise&apos;s {1} mm</source>
        <translation>, das {0}-Fache der {1} mm des Rauschens</translation>
    </message>
    <message>
        <source>--components rows if rxy is in row x and column y of the matrix, --components columns if it is component y of axis x</source>
        <translation>--components rows, wenn rxy in Zeile x und Spalte y der Matrix steht, --components columns, wenn es die Komponente y der Achse x ist</translation>
    </message>
    <message>
        <source>--components wxyz if q1 is the scalar, --components xyzw if q4 is</source>
        <translation>--components wxyz, wenn q1 der Skalar ist, --components xyzw, wenn es q4 ist</translation>
    </message>
    <message>
        <source>--dds {0}: DDS did not start ({1}): check the network.</source>
        <translation>--dds {0}: DDS ist nicht gestartet ({1}): Prüfen Sie das Netzwerk.</translation>
    </message>
    <message>
        <source>--dds {0}: give the ROS domain, a whole number from 0 to {1}.</source>
        <translation>--dds {0}: Geben Sie die ROS-Domäne an, eine ganze Zahl von 0 bis {1}.</translation>
    </message>
    <message>
        <source>--down has no direction: give the direction of gravity, such as 0,0,-1.</source>
        <translation>--down hat keine Richtung: Geben Sie die Richtung der Schwerkraft an, etwa 0,0,-1.</translation>
    </message>
    <message>
        <source>--euler ORDER for the angles rx, ry, rz (xyz: about the fixed x, y and z axis in turn; ZYX: about the rotating axes), --rotation-vector if they are axis times angle</source>
        <translation>--euler ORDNUNG für die Winkel rx, ry, rz (xyz: nacheinander um die festen Achsen x, y und z; ZYX: um die mitgedrehten Achsen), --rotation-vector, wenn sie Achse mal Winkel sind</translation>
    </message>
    <message>
        <source>--facets, --max-deviation and --max-contact-error: give only one of them.</source>
        <translation>--facets, --max-deviation und --max-contact-error: Geben Sie nur eines davon an.</translation>
    </message>
    <message>
        <source>--foxglove {0}: nobody can listen there ({1}): choose another port.</source>
        <translation>--foxglove {0}: Dort kann nicht gelauscht werden ({1}): Wählen Sie einen anderen Port.</translation>
    </message>
    <message>
        <source>--igtl {0}: nobody can listen there ({1}): choose another port.</source>
        <translation>--igtl {0}: Dort kann nicht gelauscht werden ({1}): Wählen Sie einen anderen Port.</translation>
    </message>
    <message>
        <source>--mount and --estimate-mount contradict each other: give only one.</source>
        <translation>--mount und --estimate-mount widersprechen sich: Geben Sie nur eines an.</translation>
    </message>
    <message>
        <source>--mqtt {0}: give a topic after the port, such as 127.0.0.1:1883/bench.</source>
        <translation>--mqtt {0}: Geben Sie nach dem Port ein Topic an, etwa 127.0.0.1:1883/bench.</translation>
    </message>
    <message>
        <source>--pty: this system has no pseudo-terminals. Use --port.</source>
        <translation>--pty: Dieses System hat keine Pseudoterminals. Verwenden Sie --port.</translation>
    </message>
    <message>
        <source>--robot NAME for the joints j1 to j6 (known: {0})</source>
        <translation>--robot NAME für die Gelenke j1 bis j6 (bekannt: {0})</translation>
    </message>
    <message>
        <source>--{0} ({1}.{2}): {3}: correct it.</source>
        <translation>--{0} ({1}.{2}): {3}: Korrigieren Sie das.</translation>
    </message>
    <message>
        <source>--{0} needs {1}, which is not installed: {2}.</source>
        <translation>--{0} braucht {1}, das nicht installiert ist: {2}.</translation>
    </message>
    <message>
        <source>0 for no region, 1 for the first priority</source>
        <translation>0 für keine Region, 1 für die erste Priorität</translation>
    </message>
    <message>
        <source>1 marker was</source>
        <translation>1 Marker wurde</translation>
    </message>
    <message>
        <source>1 of {0} vertices is</source>
        <translation>1 von {0} Eckpunkten ist</translation>
    </message>
    <message>
        <source>1 to {0}</source>
        <translation>1 zu {0}</translation>
    </message>
    <message>
        <source>1, or that of the scene</source>
        <translation>1, oder der der Szene</translation>
    </message>
    <message>
        <source>1/190 of the size</source>
        <translation>1/190 der Größe</translation>
    </message>
    <message>
        <source>95th percentile</source>
        <translation>95. Perzentil</translation>
    </message>
    <message>
        <source>99 % of solves take up to {0} ms, more than {1} ms</source>
        <translation>99 % der Lösungen dauern bis zu {0} ms, mehr als {1} ms</translation>
    </message>
    <message>
        <source>; check whether these are degrees</source>
        <translation>; sind das Grad?</translation>
    </message>
    <message>
        <source>; intact records follow from byte {0}</source>
        <translation>; vollständige Einträge folgen ab Byte {0}</translation>
    </message>
    <message>
        <source>; it is {0} long if they are {1}</source>
        <translation>; sie ist {0} lang, wenn es {1} sind</translation>
    </message>
    <message>
        <source>; no other cause shows</source>
        <translation>; keine andere Ursache zeigt sich</translation>
    </message>
    <message>
        <source>; then {0}</source>
        <translation>; dann {0}</translation>
    </message>
    <message>
        <source>; wrenches in frame {0}</source>
        <translation>; Kräfte und Momente im Koordinatensystem {0}</translation>
    </message>
    <message>
        <source>; {0} kg was weighed</source>
        <translation>; gewogen wurden {0} kg</translation>
    </message>
    <message>
        <source>A bundle was exported to {0}: {1}, SHA-256 of contactbench.json {2}.</source>
        <translation>Ein Bundle wurde exportiert nach {0}: {1}, SHA-256 von contactbench.json {2}.</translation>
    </message>
    <message>
        <source>A channel is at the end of its range: remove the load, and use less force.</source>
        <translation>Ein Kanal ist am Ende seines Messbereichs: die Last entfernen und weniger Kraft anwenden.</translation>
    </message>
    <message>
        <source>A channel is at {0} % of its range; it clips at 100 %. Reduce the load, or re-zero the sensor.</source>
        <translation>Ein Kanal ist bei {0} % seines Messbereichs; bei 100 % wird er abgeschnitten. Verringern Sie die Last, oder nullen Sie den Sensor neu.</translation>
    </message>
    <message>
        <source>A channel is beyond the sensor&apos;s range: remove the load, and use less force.</source>
        <translation>Ein Kanal ist außerhalb des Messbereichs des Sensors: die Last entfernen und weniger Kraft anwenden.</translation>
    </message>
    <message>
        <source>A compensation error common to all touches looks like a mount error: {0}, {1}. The mount cannot be better than its calibration.</source>
        <translation>Ein Kompensationsfehler, der allen Berührungen gemeinsam ist, sieht wie ein Montagefehler aus: {0}, {1}. Die Montage kann nicht besser sein als ihre Kalibrierung.</translation>
    </message>
    <message>
        <source>A contact cannot be located without {0}: {1}.</source>
        <translation>Ein Kontakt lässt sich nicht lokalisieren, es fehlt {0}: {1}.</translation>
    </message>
    <message>
        <source>A contact farther than this from every marker touched none, mm.</source>
        <translation>Ein Kontakt, der von jedem Marker weiter als das entfernt ist, hat keinen berührt, mm.</translation>
    </message>
    <message>
        <source>A delay above {0} ms is unlikely: check that both use one clock, and that this robot holds the sensor.</source>
        <translation>Ein Verzug über {0} ms ist unwahrscheinlich: Prüfen Sie, ob beide dieselbe Uhr benutzen und ob dieser Roboter den Sensor trägt.</translation>
    </message>
    <message>
        <source>A hanging weight makes no torque about its own line, but the sensor reads {0} mm times its force. Torque channels are swapped, one has the wrong sign, or the weight was held.</source>
        <translation>Ein hängendes Gewicht erzeugt um seine eigene Linie kein Drehmoment, gemessen werden aber {0} mm mal seiner Kraft. Drehmomentkanäle sind vertauscht, einer hat das falsche Vorzeichen, oder das Gewicht wurde gehalten.</translation>
    </message>
    <message>
        <source>A message on {0} is damaged and was left out ({1}).</source>
        <translation>Eine Nachricht auf {0} ist beschädigt und ausgelassen ({1}).</translation>
    </message>
    <message>
        <source>A message on {0} was left out ({1}).</source>
        <translation>Eine Nachricht auf {0} ist ausgelassen ({1}).</translation>
    </message>
    <message>
        <source>A mix-up of degrees and radians can only be tested with the angles as they were written.</source>
        <translation>Eine Verwechslung von Grad und Radiant lässt sich nur mit den Winkeln prüfen, wie sie geschrieben wurden.</translation>
    </message>
    <message>
        <source>A row on {0} is no message and was left out.</source>
        <translation>Eine Zeile auf {0} ist keine Nachricht und wurde ausgelassen.</translation>
    </message>
    <message>
        <source>A sensor ahead of the robot is unlikely: check whether the robot publishes its poses late.</source>
        <translation>Ein Sensor, der dem Roboter voraus ist, ist unwahrscheinlich: Prüfen Sie, ob der Roboter seine Posen verspätet sendet.</translation>
    </message>
    <message>
        <source>A touch begins at this |F|, N [2, less for windows below].</source>
        <translation>Ab diesem |F| beginnt eine Berührung, N [2, weniger bei kleineren Fenstern].</translation>
    </message>
    <message>
        <source>A touch ends below this |F|, N [1, less for windows below].</source>
        <translation>Unter diesem |F| endet eine Berührung, N [1, weniger bei kleineren Fenstern].</translation>
    </message>
    <message>
        <source>A touch of an untouchable facet is less likely than any other by this factor.</source>
        <translation>Eine Berührung einer unberührbaren Facette ist um diesen Faktor unwahrscheinlicher als jede andere.</translation>
    </message>
    <message>
        <source>ATI or OnRobot (RDT)</source>
        <translation>ATI oder OnRobot (RDT)</translation>
    </message>
    <message>
        <source>ATI sensor</source>
        <translation>ATI-Sensor</translation>
    </message>
    <message>
        <source>About {0} contacts per second fit on one core with these outputs; the sensor sends {1}.</source>
        <translation>Auf einen Prozessorkern passen mit diesen Ausgaben etwa {0} Kontakte pro Sekunde; der Sensor sendet {1}.</translation>
    </message>
    <message>
        <source>Accept, and follow when tracking, contacts whose place is certain only because of the regions of the mesh.</source>
        <translation>Kontakte annehmen und beim Verfolgen weiterführen, deren Ort nur durch die Regionen des Netzes sicher ist.</translation>
    </message>
    <message>
        <source>Accepted touches required per marker.</source>
        <translation>Nötige gezählte Berührungen je Marker.</translation>
    </message>
    <message>
        <source>Accuracy of hitting the point, 1 sigma, mm.</source>
        <translation>Wie genau der Punkt getroffen wird, 1 Sigma, mm.</translation>
    </message>
    <message>
        <source>All poses have the same orientation to within half a degree. Turn the wrist between poses, or check that the orientation columns are the ones the robot updates.</source>
        <translation>Alle Posen haben dieselbe Orientierung, bis auf ein halbes Grad. Drehen Sie das Handgelenk zwischen den Posen, oder prüfen Sie, ob der Roboter die Spalten der Orientierung wirklich aktualisiert.</translation>
    </message>
    <message>
        <source>All poses lie within about {0}° of one another, so bias and weight are poorly separated. Tilt the wrist further, up to 90° and beyond, about two axes.</source>
        <translation>Alle Posen liegen höchstens etwa {0}° auseinander, deshalb sind Nullpunktfehler und Gewicht schlecht getrennt. Neigen Sie das Handgelenk weiter, bis zu 90° und darüber hinaus, um zwei Achsen.</translation>
    </message>
    <message>
        <source>All poses turn about one axis ({0}, {1}, {2} in the world), so gravity and bias along it cannot be separated. Tilt the wrist about another axis too.</source>
        <translation>Alle Posen drehen um eine Achse ({0}, {1}, {2} in der Welt), deshalb sind Schwerkraft und Nullpunktfehler entlang dieser Achse nicht zu trennen. Neigen Sie das Handgelenk auch um eine andere Achse.</translation>
    </message>
    <message>
        <source>All poses turn about one horizontal axis (bearing {0}° from the world&apos;s x), so a tilt of the base along that axis and the bias along it cannot be separated. Tilt the wrist about another axis too.</source>
        <translation>Alle Posen drehen um eine waagerechte Achse (Richtung {0}° von der x-Achse der Welt), deshalb sind eine Neigung der Basis entlang dieser Achse und der Nullpunktfehler entlang ihr nicht zu trennen. Neigen Sie das Handgelenk auch um eine andere Achse.</translation>
    </message>
    <message>
        <source>All readings are exactly the same: the sensor may be frozen. Touch it to check.</source>
        <translation>Alle Messwerte sind genau gleich: Der Sensor ist vielleicht eingefroren. Berühren Sie ihn zur Probe.</translation>
    </message>
    <message>
        <source>All visible facets face outwards; only hidden ones disagree. </source>
        <translation>Alle sichtbaren Facetten zeigen nach außen; nur verdeckte widersprechen sich. </translation>
    </message>
    <message>
        <source>Also possible: {0}.</source>
        <translation>Auch möglich: {0}.</translation>
    </message>
    <message>
        <source>Angles are in rad, not degrees.</source>
        <translation>Winkel in rad, nicht in Grad.</translation>
    </message>
    <message>
        <source>Angles reach {0} rad, more than two turns: if they are in degrees, leave out --radians.</source>
        <translation>Winkel reichen bis {0} rad, mehr als zwei Umdrehungen: Falls sie in Grad sind, lassen Sie --radians weg.</translation>
    </message>
    <message>
        <source>Applying the regions to the probe.</source>
        <translation>Die Regionen werden auf die Sonde angewendet.</translation>
    </message>
    <message>
        <source>As declared, the residuals are {0}.</source>
        <translation>Wie angegeben betragen die Restabweichungen {0}.</translation>
    </message>
    <message>
        <source>At least one record is lost after record {0}.</source>
        <translation>Nach Eintrag {0} ist mindestens ein Eintrag verloren.</translation>
    </message>
    <message>
        <source>At {0} s the clock of the recording jumped by {1} s against that in the headers: one of the two was set. Nothing is interpolated over such a gap.</source>
        <translation>Bei {0} s sprang die Uhr der Aufzeichnung um {1} s gegenüber der in den Headern: Eine von beiden wurde gestellt. Über eine solche Lücke wird nichts interpoliert.</translation>
    </message>
    <message>
        <source>Automatic</source>
        <translation>Automatisch</translation>
    </message>
    <message>
        <source>Average more samples, use a stronger filter or press harder. Look for vibration, and for markers that were not hit exactly.</source>
        <translation>Mitteln Sie mehr Messwerte, filtern Sie stärker oder drücken Sie fester. Suchen Sie nach Vibrationen und nach Markern, die nicht genau getroffen wurden.</translation>
    </message>
    <message>
        <source>Averaging: keep still. The pose is captured as soon as this is done.</source>
        <translation>Mittelung läuft: stillhalten. Danach wird die Pose aufgenommen.</translation>
    </message>
    <message>
        <source>Bed.curvature {0}: give two numbers within ±{1} 1/m.</source>
        <translation>Bed.curvature {0}: zwei Zahlen innerhalb von ±{1} 1/m angeben.</translation>
    </message>
    <message>
        <source>Bed.factor {0}: give the factor by which the modulus may be off, 1 or more.</source>
        <translation>Bed.factor {0}: angeben, um das Wievielfache der Modul danebenliegen kann, 1 oder mehr.</translation>
    </message>
    <message>
        <source>Bed.modulus {0}: give a pressure per depth above 0, N/m³.</source>
        <translation>Bed.modulus {0}: einen Druck je Tiefe über 0 angeben, N/m³.</translation>
    </message>
    <message>
        <source>Between poses the torques change by up to {0}, but the forces by only {1} N: if the torques are in N·mm, divide them by 1000.</source>
        <translation>Von Pose zu Pose ändern sich Momente um bis zu {0}, Kräfte nur um {1} N: Falls die Momente in N·mm sind, teilen Sie sie durch 1000.</translation>
    </message>
    <message>
        <source>Bias, weight and noise alone explain the poses.</source>
        <translation>Nullpunktfehler, Gewicht und Rauschen allein erklären die Posen.</translation>
    </message>
    <message>
        <source>Bota: the rate must be finite and above 0 Hz, not {0}.</source>
        <translation>Bota: Die Rate muss endlich und über 0 Hz sein, nicht {0}.</translation>
    </message>
    <message>
        <source>Bota: {0} is not a baud rate of the sensor: choose one of {1}.</source>
        <translation>Bota: {0} ist keine Baudrate des Sensors: eine von diesen wählen: {1}.</translation>
    </message>
    <message>
        <source>Bridged: {0} bodies, over gaps of less than {1} mm.</source>
        <translation>Überbrückt: {0} Körper, über Spalte von weniger als {1} mm.</translation>
    </message>
    <message>
        <source>Bumped, or left too early: {0}. The next capture starts once everything is still.</source>
        <translation>Angestoßen oder zu früh verlassen: {0}. Die nächste Aufnahme beginnt, wenn alles ruhig ist.</translation>
    </message>
    <message>
        <source>But residuals of this size move a contact by {0} mm, and nothing shows whether they are noise. Give the noise from the sensor&apos;s data sheet.</source>
        <translation>Aber Restabweichungen dieser Größe verschieben einen Kontakt um {0} mm, und nichts zeigt, ob sie Rauschen sind. Geben Sie das Rauschen aus dem Datenblatt des Sensors an.</translation>
    </message>
    <message>
        <source>But the units cannot be determined without the tool&apos;s mass: {0} kg as declared, or {1}. Weigh the tool and give its mass.</source>
        <translation>Aber ohne die Masse des Werkzeugs lassen sich die Einheiten nicht erkennen: {0} kg wie angegeben, oder {1}. Wiegen Sie das Werkzeug, und geben Sie seine Masse an.</translation>
    </message>
    <message>
        <source>But then {0}. Correct this, then check again for a second mistake.</source>
        <translation>Aber dann gilt: {0}. Berichtigen Sie dies und prüfen Sie dann noch einmal auf einen zweiten Fehler.</translation>
    </message>
    <message>
        <source>But {0} would fit equally well. Press one known point and compare.</source>
        <translation>Aber ebenso gut würde passen: {0}. Drücken Sie auf einen bekannten Punkt, und vergleichen Sie.</translation>
    </message>
    <message>
        <source>But {0}. Check what was declared about the tool and the world&apos;s z axis.</source>
        <translation>Aber: {0}. Prüfen Sie, was über das Werkzeug und die z-Achse der Welt angegeben wurde.</translation>
    </message>
    <message>
        <source>By column t the poses are {0} apart, but a pose takes a second: write t in s. If the rows are samples of a recording, give the whole recording.</source>
        <translation>Nach Spalte t liegen die Posen {0} auseinander, und eine Pose dauert eine Sekunde: t in s schreiben. Falls die Zeilen Messwerte einer Aufzeichnung sind, die ganze Aufzeichnung angeben.</translation>
    </message>
    <message>
        <source>By the torques, the weight hangs {0} m from the sensor, beyond {1} mm.</source>
        <translation>Nach den Drehmomenten hängt das Gewicht {0} m vom Sensor entfernt, weiter als {1} mm.</translation>
    </message>
    <message>
        <source>By their times the {0} readings span {1} s, too short for a still pose: times must be in s. If they are in minutes, name the column t_min.</source>
        <translation>Nach ihren Zeiten umfassen die {0} Messwerte {1} s, zu kurz für eine ruhige Pose: Zeiten müssen in s angegeben sein. Sind es Minuten, die Spalte t_min nennen.</translation>
    </message>
    <message>
        <source>Bytes after the last facet of the STL file were left out (bytes: {0}).</source>
        <translation>Bytes nach der letzten Facette der STL-Datei wurden ausgelassen (Bytes: {0}).</translation>
    </message>
    <message>
        <source>Bytes after the last row of the PLY file were left out (bytes: {0}).</source>
        <translation>Bytes nach der letzten Zeile der PLY-Datei wurden ausgelassen (Bytes: {0}).</translation>
    </message>
    <message>
        <source>Bytes {0} to {1} of the journal are damaged.</source>
        <translation>Die Bytes {0} bis {1} des Journals sind beschädigt.</translation>
    </message>
    <message>
        <source>Calibrate first.</source>
        <translation>Kalibrieren Sie zuerst.</translation>
    </message>
    <message>
        <source>Calibrate gravity and prepare the probe first.</source>
        <translation>Kalibrieren Sie zuerst die Schwerkraft, und bereiten Sie die Sonde vor.</translation>
    </message>
    <message>
        <source>Calibrate gravity first.</source>
        <translation>Kalibrieren Sie zuerst die Schwerkraft.</translation>
    </message>
    <message>
        <source>Calibrate the sensor with this tool.</source>
        <translation>Kalibrieren Sie den Sensor mit diesem Werkzeug.</translation>
    </message>
    <message>
        <source>Calibrate with --estimate-mount, or correct the mounting.</source>
        <translation>Mit --estimate-mount kalibrieren oder die Montage berichtigen.</translation>
    </message>
    <message>
        <source>Calibrate with only the poses before it or only those after it, and stop the sensor from re-zeroing itself.</source>
        <translation>Kalibrieren Sie nur mit den Posen davor oder nur mit denen danach, und sorgen Sie dafür, dass der Sensor sich nicht selbst neu nullt.</translation>
    </message>
    <message>
        <source>Calibrated on {0}.{1}</source>
        <translation>Kalibriert am {0}.{1}</translation>
    </message>
    <message>
        <source>Calibration</source>
        <translation>Kalibrierung</translation>
    </message>
    <message>
        <source>Cannot be distinguished from: {0}. {1}</source>
        <translation>Nicht zu unterscheiden von: {0}. {1}</translation>
    </message>
    <message>
        <source>Captured: {0} s averaged, ± {1} N and ± {2} mN·m. Go to the next pose.</source>
        <translation>Aufgenommen: {0} s gemittelt, ± {1} N und ± {2} mN·m. Weiter zur nächsten Pose.</translation>
    </message>
    <message>
        <source>Channels are swapped: {0}</source>
        <translation>Kanäle sind vertauscht: {0}</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>Prüfen</translation>
    </message>
    <message>
        <source>Check the unit of the torques.</source>
        <translation>Die Einheit der Drehmomente prüfen.</translation>
    </message>
    <message>
        <source>Check this channel&apos;s plug and scale, and have the sensor recalibrated.</source>
        <translation>Stecker und Skalierung dieses Kanals prüfen und den Sensor neu kalibrieren lassen.</translation>
    </message>
    <message>
        <source>Choose a larger range, check this channel&apos;s offset, and retake the poses.</source>
        <translation>Einen größeren Messbereich wählen, den Nullpunkt dieses Kanals prüfen und die Posen neu aufnehmen.</translation>
    </message>
    <message>
        <source>Choose the devices first.</source>
        <translation>Wählen Sie zuerst die Geräte.</translation>
    </message>
    <message>
        <source>Choose the probe&apos;s mesh, align it and simplify it.</source>
        <translation>Wählen Sie das Netz der Sonde, richten Sie es aus, und vereinfachen Sie es.</translation>
    </message>
    <message>
        <source>Choose the sensor and the source of its orientation, then test the connection.</source>
        <translation>Wählen Sie den Sensor und die Quelle seiner Orientierung, und testen Sie dann die Verbindung.</translation>
    </message>
    <message>
        <source>Chosen: {0}. Not connected: connect to measure.</source>
        <translation>Gewählt: {0}. Nicht verbunden: Verbinden Sie, um zu messen.</translation>
    </message>
    <message>
        <source>Clearance.distance: give a length of at least 0 (m), not {0}</source>
        <translation>Clearance.distance: Geben Sie eine Länge von mindestens 0 an (m), nicht {0}</translation>
    </message>
    <message>
        <source>Clearance.p_ET_E: give three finite numbers (m), not {0}</source>
        <translation>Clearance.p_ET_E: Geben Sie drei endliche Zahlen an (m), nicht {0}</translation>
    </message>
    <message>
        <source>Clearance.tool_radius: give a length above 0 (m), not {0}</source>
        <translation>Clearance.tool_radius: Geben Sie eine Länge über 0 an (m), nicht {0}</translation>
    </message>
    <message>
        <source>Clearance.z_min: give a height in B (m) or -inf, not {0}</source>
        <translation>Clearance.z_min: Geben Sie eine Höhe in B an (m) oder -inf, nicht {0}</translation>
    </message>
    <message>
        <source>Closed parts lie inside the body (parts: {0}). They cannot be touched, but a line of force can hit them. {1}</source>
        <translation>Geschlossene Teile liegen im Inneren des Körpers (Teile: {0}). Nichts kann sie berühren, aber die Wirkungslinie einer Kraft trifft sie. {1}</translation>
    </message>
    <message>
        <source>Colour by the logarithm: few contacts show beside many.</source>
        <translation>Farbe nach dem Logarithmus: wenige Kontakte sind neben vielen zu sehen.</translation>
    </message>
    <message>
        <source>Compensate them first: contactbench calibrate compensate calibration.json RECORDING --out WRENCHES.</source>
        <translation>Zuerst kompensieren: contactbench calibrate compensate calibration.json RECORDING --out WRENCHES.</translation>
    </message>
    <message>
        <source>Compiled solves of the touches judged, µs, all in one run. × full is the median over the full mesh&apos;s; loop is the paper&apos;s Algorithm 1, which stops at the first facet that accepts, priority regions first. Deviation in mm.</source>
        <translation>Kompilierte Lösungen der beurteilten Berührungen, µs, alle in einem Lauf. × full ist der Median geteilt durch den des vollen Netzes; loop ist Algorithmus 1 der Veröffentlichung, der bei der ersten annehmenden Facette anhält, Regionen mit Priorität zuerst. Abweichung in mm.</translation>
    </message>
    <message>
        <source>Connected: {0}.</source>
        <translation>Verbunden: {0}.</translation>
    </message>
    <message>
        <source>Contact error</source>
        <translation>Kontaktfehler</translation>
    </message>
    <message>
        <source>ContactTask.normal: give three numbers that are not all 0, not {0}</source>
        <translation>ContactTask.normal: Geben Sie drei Zahlen an, die nicht alle 0 sind, nicht {0}</translation>
    </message>
    <message>
        <source>ContactTask.point: give three finite numbers, m in S, not {0}</source>
        <translation>ContactTask.point: Geben Sie drei endliche Zahlen an, m in S, nicht {0}</translation>
    </message>
    <message>
        <source>ContactTask.{0}: {1} is not between 0 and {2}</source>
        <translation>ContactTask.{0}: {1} liegt nicht zwischen 0 und {2}</translation>
    </message>
    <message>
        <source>Contactbench takes {0} µs a solve ({1} on the full mesh), the paper&apos;s loop {2} µs ({3}).</source>
        <translation>Contactbench braucht {0} µs für eine Lösung ({1} auf dem vollen Netz), die Schleife der Veröffentlichung {2} µs ({3}).</translation>
    </message>
    <message>
        <source>Contacts have not been verified on markers: verify first.</source>
        <translation>Kontakte sind nicht an Markern überprüft: zuerst überprüfen.</translation>
    </message>
    <message>
        <source>Contacts move in proportion to the load, as with a wrong gain or crosstalk of the sensor: hang a known weight on the tool to see it, and have the sensor recalibrated.</source>
        <translation>Die Kontakte verschieben sich im Verhältnis zur Last, wie bei falscher Verstärkung oder Übersprechen des Sensors: Zum Nachweis ein bekanntes Gewicht an das Werkzeug hängen und den Sensor neu kalibrieren lassen.</translation>
    </message>
    <message>
        <source>Contacts on flipped facets are missed. </source>
        <translation>Kontakte auf den umgedrehten werden übersehen. </translation>
    </message>
    <message>
        <source>Contacts on invented facets: {0} of {1}. The mesh file had an opening there, so surface and contacts are guesses.</source>
        <translation>Kontakte auf erfundenen Facetten: {0} von {1}. Die Netzdatei hatte dort eine Öffnung, Fläche und Kontakte sind Vermutungen.</translation>
    </message>
    <message>
        <source>Contacts on untouchable regions: {0} of {1}. Nothing should be able to touch there: check the region, then the mount and the compensation.</source>
        <translation>Kontakte auf unberührbaren Regionen: {0} von {1}. Nichts sollte dort berühren können: Prüfen Sie die Region, dann die Montage und die Kompensation.</translation>
    </message>
    <message>
        <source>Contacts there are missed or found on the far side. Keep more facets, or repair the mesh there.</source>
        <translation>Kontakte dort werden übersehen oder auf der Gegenseite gefunden. Behalten Sie mehr Facetten, oder bessern Sie das Netz dort aus.</translation>
    </message>
    <message>
        <source>Contacts were verified at {0} readings per second, but the config is for {1}: verify again at this rate.</source>
        <translation>Kontakte wurden mit {0} Messwerten pro Sekunde überprüft, die Konfiguration ist für {1}: mit dieser Rate erneut prüfen.</translation>
    </message>
    <message>
        <source>Controller, {0}: on tissue of {1} N/m an arm leaves a gain margin of {2} and a phase margin of {3} degrees: choose lower gains, such as those of control tune.</source>
        <translation>Regelung, {0}: Auf Gewebe von {1} N/m lässt ein Arm eine Amplitudenreserve von {2} und eine Phasenreserve von {3} Grad: kleinere Verstärkungen wählen, etwa die von control tune.</translation>
    </message>
    <message>
        <source>Convert again as {0}, or give contactbench the original angles.</source>
        <translation>Rechnen Sie neu um, als {0}, oder geben Sie contactbench die ursprünglichen Winkel.</translation>
    </message>
    <message>
        <source>Correct the column names or the order of the export: contactbench expects qw, qx, qy, qz.</source>
        <translation>Berichtigen Sie die Spaltennamen oder die Reihenfolge beim Export: contactbench erwartet qw, qx, qy, qz.</translation>
    </message>
    <message>
        <source>Correct the sensor&apos;s mounting: R_WS becomes R_WS · Rz({0}).</source>
        <translation>Berichtigen Sie die Montage des Sensors: R_WS wird zu R_WS · Rz({0}).</translation>
    </message>
    <message>
        <source>DDS domain {0}</source>
        <translation>DDS-Domäne {0}</translation>
    </message>
    <message>
        <source>Datagrams left out: {0}, the last one from {1}, port {2}. Only port {3} of {4} is listened to: stop the other sender, or give each a port of this computer.</source>
        <translation>Ausgelassene Datagramme: {0}, das letzte von {1}, Port {2}. Angenommen wird nur, was von Port {3} von {4} kommt: Beenden Sie den anderen Sender, oder geben Sie jedem einen eigenen Port dieses Rechners.</translation>
    </message>
    <message>
        <source>Delay of a wrench after its pose in a recording of both; auto: estimated from the motion. A doubtful estimate is reported but not applied [0].</source>
        <translation>Verzug eines Messwerts gegenüber seiner Pose in einer Aufzeichnung von beidem; auto: aus der Bewegung geschätzt. Eine zweifelhafte Schätzung wird gemeldet, aber nicht angewendet [0].</translation>
    </message>
    <message>
        <source>Delay of a wrench after its pose, s.</source>
        <translation>Verzögerung eines Messwerts gegen seine Pose, s.</translation>
    </message>
    <message>
        <source>Direction of gravity in the world frame of the orientations, of any length; 0,0,1 for a robot that hangs from the ceiling and reports poses in its base frame.</source>
        <translation>Richtung der Schwerkraft im Weltsystem der Orientierungen, beliebig lang; 0,0,1 für einen Roboter, der an der Decke hängt und Posen im System seiner Basis meldet.</translation>
    </message>
    <message>
        <source>Distance from the visible outside of the original to the shell: median {0} mm, 95 % below {1} mm, at most {2} mm.</source>
        <translation>Abstand von der sichtbaren Außenseite des Originals zur Außenfläche: Median {0} mm, 95 % unter {1} mm, höchstens {2} mm.</translation>
    </message>
    <message>
        <source>Distances between the contacts on this mesh and on the full one, of touches settled by both, mm. × noise is p95 over the noise bound; growth that of the whole error. Doubtful, lost, jumped: settled on the full mesh, here with a warning, without a point, or elsewhere without a warning. * recommended.</source>
        <translation>Abstände zwischen den Kontakten auf diesem Netz und auf dem vollen, bei Berührungen, die beide eindeutig orten, mm. × noise ist p95 geteilt durch die Rauschgrenze; growth das Wachstum des gesamten Fehlers. Doubtful, lost, jumped: auf dem vollen Netz eindeutig geortet, hier mit Warnung, ohne Punkt, oder anderswo ohne Warnung. * empfohlen.</translation>
    </message>
    <message>
        <source>Distances between the points in the sensor frame are {0} times those in the mesh: give both in the same unit, and the points in the same order.</source>
        <translation>Die Abstände zwischen den Punkten im Sensorsystem sind das {0}-Fache derer im Netz: Geben Sie beide in derselben Einheit und die Punkte in derselben Reihenfolge an.</translation>
    </message>
    <message>
        <source>Divide mx, my and mz by 1000.</source>
        <translation>mx, my und mz durch 1000 teilen.</translation>
    </message>
    <message>
        <source>Do not filter the wrench.</source>
        <translation>Die Kräfte und Momente nicht filtern.</translation>
    </message>
    <message>
        <source>Drift, cable, hysteresis and mount change each wrench by about this much; the bundle allows for it.</source>
        <translation>Drift, Kabel, Hysterese und Halterung verändern jeden Messwert um etwa so viel; das Bundle berücksichtigt es.</translation>
    </message>
    <message>
        <source>Edges are {0} long; half of them are shorter than {1}.</source>
        <translation>Kanten sind {0} lang; die Hälfte davon ist kürzer als {1}.</translation>
    </message>
    <message>
        <source>Elfin: asked for {0}, received {1}. Reconnect.</source>
        <translation>Elfin: Gefragt war {0}, geantwortet wurde {1}. Neu verbinden.</translation>
    </message>
    <message>
        <source>Elfin: joints and pose do not match: the tool frame is {0} from the flange of {1}. Choose a tool frame without rotation, and check the robot model.</source>
        <translation>Elfin: Gelenke und Pose passen nicht zusammen: Das Werkzeugsystem ist vom Flansch entfernt um {0}, bei {1}. Ein Werkzeugsystem ohne Drehung wählen und das Modell des Roboters prüfen.</translation>
    </message>
    <message>
        <source>Elfin: joints and pose look the same here. Move the arm and try again.</source>
        <translation>Elfin: Gelenke und Pose sehen hier gleich aus. Den Arm bewegen und noch einmal versuchen.</translation>
    </message>
    <message>
        <source>Elfin: the controller does not know {0}. Use another query.</source>
        <translation>Elfin: Die Steuerung kennt {0} nicht. Eine andere Abfrage verwenden.</translation>
    </message>
    <message>
        <source>Elfin: the controller refused {0} with error code {1}. Look it up on the robot&apos;s panel.</source>
        <translation>Elfin: Die Steuerung hat {0} mit dem Fehlercode {1} abgelehnt: am Bedienpult des Roboters nachsehen.</translation>
    </message>
    <message>
        <source>Elfin: {0} are not six angles and a pose: reconnect.</source>
        <translation>Elfin: {0} sind nicht sechs Winkel und eine Pose: neu verbinden.</translation>
    </message>
    <message>
        <source>Elfin: {0} is not a finite number: the controller has no position yet.</source>
        <translation>Elfin: {0} ist keine endliche Zahl: Die Steuerung hat noch keine Position.</translation>
    </message>
    <message>
        <source>Elfin: {0} returned {1} values instead of {2}: this controller&apos;s software is not supported.</source>
        <translation>Elfin: {0} lieferte {1} Werte statt {2}: Die Software dieser Steuerung wird nicht unterstützt.</translation>
    </message>
    <message>
        <source>End of the recording: choose it again to replay it.</source>
        <translation>Ende der Aufzeichnung: Wählen Sie sie noch einmal, um sie erneut abzuspielen.</translation>
    </message>
    <message>
        <source>Error</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Error that drift, cable and hysteresis leave in a force, 1 sigma.</source>
        <translation>Fehler, den Drift, Kabel und Hysterese in einer Kraft lassen, 1 Sigma.</translation>
    </message>
    <message>
        <source>Euler angles about the fixed axes {0}</source>
        <translation>Eulerwinkel um die festen Achsen {0}</translation>
    </message>
    <message>
        <source>Euler angles in the order {0}</source>
        <translation>Eulerwinkel in der Reihenfolge {0}</translation>
    </message>
    <message>
        <source>Euler angles {0}</source>
        <translation>Eulerwinkel {0}</translation>
    </message>
    <message>
        <source>Euler order {0}: give three axes, such as xyz (fixed axes) or ZYX (rotating axes)</source>
        <translation>Euler-Reihenfolge {0}: Geben Sie drei Achsen an, etwa xyz (feste Achsen) oder ZYX (mitdrehende Achsen)</translation>
    </message>
    <message>
        <source>Every pose has exactly the same reading although the tool was turned: the sensor is not responding. Check its cable and its power.</source>
        <translation>Jede Pose hat genau denselben Messwert, obwohl das Werkzeug gedreht wurde: Der Sensor antwortet nicht. Prüfen Sie sein Kabel und seine Stromversorgung.</translation>
    </message>
    <message>
        <source>Every pose has the same orientation, so bias and weight cannot be separated. Turn the wrist between poses, about two axes, by 60° or more.</source>
        <translation>Jede Pose hat dieselbe Orientierung, deshalb sind Nullpunktfehler und Gewicht nicht zu trennen. Drehen Sie das Handgelenk zwischen den Posen um zwei Achsen, um 60° oder mehr.</translation>
    </message>
    <message>
        <source>Every pose has the same tilt (they differ only by a turn about the vertical), so gravity always has the same direction in the sensor, and weight and bias cannot be separated. Turn the wrist about a horizontal axis.</source>
        <translation>Jede Pose hat dieselbe Neigung (sie unterscheiden sich nur durch eine Drehung um die Senkrechte), deshalb hat die Schwerkraft im Sensor immer dieselbe Richtung, und Gewicht und Nullpunktfehler sind nicht zu trennen. Drehen Sie das Handgelenk um eine waagerechte Achse.</translation>
    </message>
    <message>
        <source>Expected touch forces, N.</source>
        <translation>Kräfte der erwarteten Berührungen, N.</translation>
    </message>
    <message>
        <source>Export the config again.</source>
        <translation>Die Konfiguration erneut exportieren.</translation>
    </message>
    <message>
        <source>Facet density inside regions relative to outside.</source>
        <translation>Facettendichte in Regionen im Verhältnis zu außerhalb.</translation>
    </message>
    <message>
        <source>Facet size</source>
        <translation>Facettengröße</translation>
    </message>
    <message>
        <source>Facet size of the outer surface.</source>
        <translation>Facettengröße der Außenfläche.</translation>
    </message>
    <message>
        <source>Facets are turned against the original surface (facets: {0}, by up to {1}°). {2}</source>
        <translation>Facetten sind gegen die ursprüngliche Oberfläche verdreht (Facetten: {0}, um bis zu {1}°). {2}</translation>
    </message>
    <message>
        <source>Facets cut through each other (pairs: {0}). Inside and outside are mixed up there, so a contact can land on an inner wall. {1}</source>
        <translation>Facetten durchschneiden einander (Paare: {0}). Innen und außen sind dort nicht zu trennen, und ein Kontakt kann auf einer Innenwand landen. {1}</translation>
    </message>
    <message>
        <source>Facets cut where others crossed or touched them: {0}.</source>
        <translation>Facetten, die zerteilt wurden, wo andere sie durchschnitten oder berührten: {0}.</translation>
    </message>
    <message>
        <source>Facets have no area (facets: {0}) and so no normal. Remove them in the CAD program and close the seams they leave.</source>
        <translation>Facetten haben keine Fläche (Facetten: {0}), also keine Normale. Entfernen Sie sie im CAD-Programm, und schließen Sie die Nähte, die sie hinterlassen.</translation>
    </message>
    <message>
        <source>Facets left out because they were sheets without thickness: {0}.</source>
        <translation>Facetten, die ausgelassen wurden, weil sie Blätter ohne Dicke waren: {0}.</translation>
    </message>
    <message>
        <source>Facets lie on top of each other (pairs: {0}), so a force meets two surfaces at once. {1}</source>
        <translation>Facetten liegen aufeinander (Paare: {0}), deshalb trifft eine Kraft zwei Oberflächen zugleich. {1}</translation>
    </message>
    <message>
        <source>Facets occur more than once (surplus: {0}). They slow the search and give double answers. Remove duplicate facets in the CAD program.</source>
        <translation>Facetten kommen mehrfach vor (überzählig: {0}). Sie bremsen die Suche und antworten doppelt. Entfernen Sie doppelte Facetten im CAD-Programm.</translation>
    </message>
    <message>
        <source>Facets to keep.</source>
        <translation>So viele Facetten behalten.</translation>
    </message>
    <message>
        <source>Facets touch without sharing a vertex or edge (pairs: {0}): two walls meet there. No action needed if the bodies are meant to touch.</source>
        <translation>Facetten berühren sich, ohne einen Eckpunkt oder eine Kante gemeinsam zu haben (Paare: {0}): Dort stoßen zwei Wände aneinander. Wo sich Körper berühren sollen, ist nichts zu tun.</translation>
    </message>
    <message>
        <source>Facets turned to face outwards: {0}.</source>
        <translation>Facetten, die nach außen gedreht wurden: {0}.</translation>
    </message>
    <message>
        <source>Facets with {0} of the area show their back to the outside{1}. Contacts there are missed, or found on the far side. Make the normals consistent in the CAD program, or make the outer shell.</source>
        <translation>Facetten, die ihre Rückseite nach außen kehren, Anteil an der Fläche: {0}{1}. Kontakte dort werden übersehen oder auf der Gegenseite gefunden. Machen Sie die Normalen im CAD-Programm einheitlich, oder machen Sie die Außenfläche.</translation>
    </message>
    <message>
        <source>Facets without area were left out (facets: {0}). They cannot be touched, but may have closed a seam. If the surface is open, export again with cleaner triangles.</source>
        <translation>Facetten ohne Fläche wurden ausgelassen (Facetten: {0}). Sie können nicht berührt werden, haben aber vielleicht eine Naht geschlossen. Exportieren Sie erneut mit saubereren Dreiecken, falls die Oberfläche offen ist.</translation>
    </message>
    <message>
        <source>Failed</source>
        <translation>Nicht bestanden</translation>
    </message>
    <message>
        <source>Fault</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Fewer facets would exceed the limit: the surface was left unchanged.</source>
        <translation>Weniger Facetten würden die Grenze überschreiten: Die Oberfläche blieb unverändert.</translation>
    </message>
    <message>
        <source>Filter the wrench with the paper&apos;s fixed values: contacts then lag by 68 ms at 200 Hz, and a release is noticed up to 0.2 s late.</source>
        <translation>Kraft und Drehmoment mit den festen Werten der Veröffentlichung filtern: Kontakte hinken dann bei 200 Hz um 68 ms nach, und ein Loslassen wird bis zu 0,2 s zu spät bemerkt.</translation>
    </message>
    <message>
        <source>Finer in regions</source>
        <translation>Feiner in Regionen</translation>
    </message>
    <message>
        <source>Finish a verification: its report is part of the bundle.</source>
        <translation>Beenden Sie eine Überprüfung: Ihr Bericht gehört ins Bundle.</translation>
    </message>
    <message>
        <source>Fitted to {0} of {1} touches of marked points; they determine {2} of the six combinations of shift and rotation.</source>
        <translation>Angepasst an {0} von {1} Berührungen markierter Punkte, die {2} der sechs Kombinationen von Verschiebung und Drehung zeigen.</translation>
    </message>
    <message>
        <source>Fix first: the labels of markers are swapped: {0}. Each was touched where the other is said to be, which explains {1} % of the squared error. Swap them, and verify again.</source>
        <translation>Zuerst beheben: Bezeichnungen von Markern sind vertauscht: {0}. Jeder wurde dort berührt, wo der andere liegen soll; das erklärt {1} % des quadratischen Fehlers. Vertauschen und erneut verifizieren.</translation>
    </message>
    <message>
        <source>Fix first: {0}. It explains {1} of the squared error</source>
        <translation>Zuerst beheben: {0}. Anteil am quadrierten Fehler: {1}</translation>
    </message>
    <message>
        <source>For a ROS 2 bag use: contactbench record import-ros2.</source>
        <translation>Für ein ROS-2-Bag benutzen Sie: contactbench record import-ros2.</translation>
    </message>
    <message>
        <source>Force above which a touch is counted in a recording.</source>
        <translation>Kraft, ab der eine Berührung in einer Aufzeichnung zählt.</translation>
    </message>
    <message>
        <source>Force limit for the controller.</source>
        <translation>Kraftgrenze für die Regelung.</translation>
    </message>
    <message>
        <source>Force of those touches, N.</source>
        <translation>Kraft dieser Berührungen, N.</translation>
    </message>
    <message>
        <source>Found {0}</source>
        <translation>Gefunden: {0}</translation>
    </message>
    <message>
        <source>From earlier versions; has no effect.</source>
        <translation>Aus früheren Versionen; ohne Wirkung.</translation>
    </message>
    <message>
        <source>Gains</source>
        <translation>Verstärkungen</translation>
    </message>
    <message>
        <source>Gaps narrower than this are bridged, mm [1/65 of the size].</source>
        <translation>Schmalere Spalte werden überbrückt, mm [1/65 der Größe].</translation>
    </message>
    <message>
        <source>Gates.{0}: {1}: correct it.</source>
        <translation>Gates.{0}: {1}: Korrigieren Sie das.</translation>
    </message>
    <message>
        <source>Gaussian of the distance along the surface, cut off at {0} bandwidths</source>
        <translation>Gauß-Glocke des Abstands entlang der Oberfläche, abgeschnitten bei {0} Bandbreiten</translation>
    </message>
    <message>
        <source>Give both --noise-force and --noise-torque, or neither.</source>
        <translation>Geben Sie --noise-force und --noise-torque beide an, oder keines.</translation>
    </message>
    <message>
        <source>Give the address {0}.</source>
        <translation>Geben Sie die Adresse {0} an.</translation>
    </message>
    <message>
        <source>Give the noise from the sensor&apos;s data sheet.</source>
        <translation>Geben Sie das Rauschen aus dem Datenblatt des Sensors an.</translation>
    </message>
    <message>
        <source>Good</source>
        <translation>Gut</translation>
    </message>
    <message>
        <source>Gravity has nearly the same direction in the flange in every pose, so the forces do not show how the sensor is mounted. {0}.</source>
        <translation>Die Schwerkraft hat im Flansch in jeder Pose fast dieselbe Richtung, deshalb zeigen die Kräfte nicht, wie der Sensor montiert ist. {0}.</translation>
    </message>
    <message>
        <source>Gravity has only two directions in the sensor, so the centre of mass along the line between them and the torque bias cannot be separated. Add a pose with a third tilt.</source>
        <translation>Die Schwerkraft hat im Sensor nur zwei Richtungen, deshalb sind der Schwerpunkt entlang der Linie zwischen ihnen und der Nullpunktfehler der Momente nicht zu trennen. Fügen Sie eine Pose mit einer dritten Neigung hinzu.</translation>
    </message>
    <message>
        <source>Gravity has the same direction in the sensor in every pose, so the centre of mass and the torque bias cannot be separated. Tilt the wrist about a horizontal axis.</source>
        <translation>Die Schwerkraft hat im Sensor in jeder Pose dieselbe Richtung, deshalb sind Schwerpunkt und Nullpunktfehler der Momente nicht zu trennen. Neigen Sie das Handgelenk um eine waagerechte Achse.</translation>
    </message>
    <message>
        <source>Gravity in the calibration is tilted by {0} deg from the vertical of its world frame. Taken as vertical, it leaves up to {1} N and {2} N*m in a compensated wrench, where the calibration itself leaves {3} N and {4} N*m (1 sigma). Level the base, or put its tilt into the robot description, and calibrate again.</source>
        <translation>Die Schwerkraft in der Kalibrierung ist um {0} deg gegen die Senkrechte ihres Weltsystems geneigt. Als senkrecht angenommen, lässt sie bis zu {1} N und {2} N*m in den kompensierten Kräften und Momenten zurück, wo die Kalibrierung selbst {3} N und {4} N*m (1 Sigma) zurücklässt. Richten Sie die Basis waagerecht aus, oder tragen Sie ihre Neigung in die Roboterbeschreibung ein, und kalibrieren Sie erneut.</translation>
    </message>
    <message>
        <source>Gravity is {0}° off vertical: the base is not level, or something such as a cable pulls sideways all the time and counts as weight. Check the base and the cables.</source>
        <translation>Die Schwerkraft liegt {0}° neben der Senkrechten: Die Basis ist nicht waagerecht, oder etwas wie ein Kabel zieht ständig zur Seite und zählt als Gewicht. Prüfen Sie Basis und Kabel.</translation>
    </message>
    <message>
        <source>Gravity points along {0} of the world frame</source>
        <translation>Die Schwerkraft zeigt entlang {0} des Weltsystems</translation>
    </message>
    <message>
        <source>GravityModel.{0}: give finite numbers of shape {1}, not {2}</source>
        <translation>GravityModel.{0}: Geben Sie endliche Zahlen der Form {1} an, nicht {2}</translation>
    </message>
    <message>
        <source>Hang a known weight on the tool.</source>
        <translation>Ein bekanntes Gewicht an das Werkzeug hängen.</translation>
    </message>
    <message>
        <source>Hang a known weight on the tool: only an error of the sensor grows with it.</source>
        <translation>Ein bekanntes Gewicht an das Werkzeug hängen: Nur ein Fehler des Sensors wächst damit.</translation>
    </message>
    <message>
        <source>Hold it steady.</source>
        <translation>Ruhig halten.</translation>
    </message>
    <message>
        <source>Hold one pose for longer: only a filter&apos;s reading creeps.</source>
        <translation>Eine Pose länger halten: Nur der Messwert eines Filters kriecht.</translation>
    </message>
    <message>
        <source>Hold the tool still in about six orientations; the next one is always shown.</source>
        <translation>Halten Sie das Werkzeug in etwa sechs Orientierungen still; die nächste wird gezeigt.</translation>
    </message>
    <message>
        <source>How far facets may lie from the curved surfaces of a STEP file.</source>
        <translation>Wie weit Facetten von den gekrümmten Flächen einer STEP-Datei abweichen dürfen.</translation>
    </message>
    <message>
        <source>Identical, byte for byte.</source>
        <translation>Identisch, Byte für Byte.</translation>
    </message>
    <message>
        <source>If the robot hangs from a ceiling or a wall, or the orientations are those of another frame, pass --down {0}.</source>
        <translation>Falls der Roboter an einer Decke oder Wand hängt oder die Orientierungen in einem anderen System gelten, geben Sie --down {0} an.</translation>
    </message>
    <message>
        <source>If the sensor is mounted that way, the data are correct as they are.</source>
        <translation>Falls der Sensor so montiert ist, stimmen die Daten, wie sie sind.</translation>
    </message>
    <message>
        <source>In preparation: continue where you left off, then use it.</source>
        <translation>In Vorbereitung: Machen Sie weiter, wo Sie aufgehört haben, und verwenden Sie sie dann.</translation>
    </message>
    <message>
        <source>In region {0}</source>
        <translation>In Region {0}</translation>
    </message>
    <message>
        <source>In {0} new {1} the residuals move a contact by {2} mm rms, at most {3} mm ({4})</source>
        <translation>In {0} {1} verschieben die Restabweichungen einen Kontakt um {2} mm (quadratisches Mittel), höchstens {3} mm ({4})</translation>
    </message>
    <message>
        <source>Inconclusive</source>
        <translation>Nicht zu entscheiden</translation>
    </message>
    <message>
        <source>Integral of a density over the surface.</source>
        <translation>Integral einer Dichte über die Oberfläche.</translation>
    </message>
    <message>
        <source>Invert the orientations</source>
        <translation>Orientierungen umkehren</translation>
    </message>
    <message>
        <source>It does not count. Restore it if it was good.</source>
        <translation>Sie zählt nicht. Stellen Sie sie wieder her, wenn sie gut war.</translation>
    </message>
    <message>
        <source>It is</source>
        <translation>Es ist</translation>
    </message>
    <message>
        <source>It may equally have been before pose {0}.</source>
        <translation>Es kann ebenso gut vor Pose {0} gewesen sein.</translation>
    </message>
    <message>
        <source>It measures {0} x {1} x {2} mm, with an area of {3} cm²</source>
        <translation>Es misst {0} x {1} x {2} mm, mit einer Fläche von {3} cm²</translation>
    </message>
    <message>
        <source>It was computed from the {0}, which is stale: {1}</source>
        <translation>Es wurde aus einem veralteten Ergebnis berechnet, {0}: {1}</translation>
    </message>
    <message>
        <source>It was rejected. {0} {1}</source>
        <translation>Es wurde abgelehnt. {0} {1}</translation>
    </message>
    <message>
        <source>It was {0}: {1}.</source>
        <translation>Es war {0}: {1}.</translation>
    </message>
    <message>
        <source>Items that the 3MF file marks as not printed were left out (items: {0}).</source>
        <translation>Teile, die laut 3MF-Datei nicht gedruckt werden, wurden ausgelassen (Anzahl: {0}).</translation>
    </message>
    <message>
        <source>K: warming of the sensor after the calibration.</source>
        <translation>K: so viel wärmer wird der Sensor nach der Kalibrierung.</translation>
    </message>
    <message>
        <source>KalmanFilter.reset: the state must be finite, not {0}; or give none</source>
        <translation>KalmanFilter.reset: der Zustand muss endlich sein, nicht {0}; oder keinen angeben</translation>
    </message>
    <message>
        <source>KalmanFilter: dt has shape {0}; give one number or {1}</source>
        <translation>KalmanFilter: dt hat die Form {0}; eine Zahl oder {1} angeben</translation>
    </message>
    <message>
        <source>KalmanFilter: every dt must be positive and finite (seconds); is a time repeated?</source>
        <translation>KalmanFilter: jedes dt muss positiv und endlich sein (Sekunden); ist eine Zeit doppelt?</translation>
    </message>
    <message>
        <source>KalmanFilter: {0} channels after {1}; call reset() for another stream</source>
        <translation>KalmanFilter: {0} Kanäle nach {1}; für einen anderen Datenstrom reset() aufrufen</translation>
    </message>
    <message>
        <source>Keep the full mesh of {0} facets</source>
        <translation>Behalten Sie das volle Netz mit {0} Facetten</translation>
    </message>
    <message>
        <source>Known touch</source>
        <translation>Bekannter Druckpunkt</translation>
    </message>
    <message>
        <source>Known weight</source>
        <translation>Bekanntes Gewicht</translation>
    </message>
    <message>
        <source>Largest error that passes, mm.</source>
        <translation>Größter Fehler, der besteht, mm.</translation>
    </message>
    <message>
        <source>Largest permitted error.</source>
        <translation>Größter zulässiger Fehler.</translation>
    </message>
    <message>
        <source>Largest permitted mean error.</source>
        <translation>Größter zulässiger mittlerer Fehler.</translation>
    </message>
    <message>
        <source>Largest plausible distance of the weight&apos;s string from the sensor, mm.</source>
        <translation>Größter glaubhafter Abstand der Schnur des Gewichts vom Sensor, mm.</translation>
    </message>
    <message>
        <source>Largest scale error that passes, %.</source>
        <translation>Größter Maßstabsfehler, der besteht, %.</translation>
    </message>
    <message>
        <source>Largest sigma</source>
        <translation>Größtes Sigma</translation>
    </message>
    <message>
        <source>Leave it out</source>
        <translation>Auslassen</translation>
    </message>
    <message>
        <source>Leave out --inverse.</source>
        <translation>Lassen Sie --inverse weg.</translation>
    </message>
    <message>
        <source>Leave out --radians.</source>
        <translation>Lassen Sie --radians weg.</translation>
    </message>
    <message>
        <source>Leave out the smaller part</source>
        <translation>Kleineren Teil auslassen</translation>
    </message>
    <message>
        <source>Left out: {0}. {1}, to have {2} poses or more.</source>
        <translation>Ausgelassen: {0}. {1}, damit es mindestens {2} Posen sind.</translation>
    </message>
    <message>
        <source>Let go.</source>
        <translation>Loslassen.</translation>
    </message>
    <message>
        <source>Let the sensor warm up, then retake the poses without a long pause.</source>
        <translation>Lassen Sie den Sensor warmlaufen, dann nehmen Sie die Posen ohne lange Pause noch einmal auf.</translation>
    </message>
    <message>
        <source>Lift the probe clear for half a second: the zero follows.</source>
        <translation>Die Sonde eine halbe Sekunde frei anheben: Der Nullpunkt folgt.</translation>
    </message>
    <message>
        <source>Likely cause: {0}.</source>
        <translation>Wahrscheinliche Ursache: {0}.</translation>
    </message>
    <message>
        <source>Limits</source>
        <translation>Grenzen</translation>
    </message>
    <message>
        <source>Limits: give 0 &lt; good_error &lt;= usable_error, m, not {0} and {1}</source>
        <translation>Limits: 0 &lt; good_error &lt;= usable_error in m angeben, nicht {0} und {1}</translation>
    </message>
    <message>
        <source>Lines dropped: {0}, because {1}.</source>
        <translation>Verworfene Zeilen: {0}. Grund: {1}.</translation>
    </message>
    <message>
        <source>Lines {0} and {1} have exactly the same reading although the sensor was turned between them{2}: the reading was copied, or the readings are shifted by a row. Correct or remove the pose.</source>
        <translation>Die Zeilen {0} und {1} haben genau denselben Messwert, obwohl der Sensor dazwischen gedreht wurde{2}: Der Messwert wurde kopiert, oder die Messwerte sind um eine Zeile verschoben. Berichtigen oder entfernen Sie die Pose.</translation>
    </message>
    <message>
        <source>Live outputs need a sensor and a source of poses: open them in step 1.</source>
        <translation>Live-Ausgaben brauchen einen Sensor und eine Quelle der Posen: Öffnen Sie beide in Schritt 1.</translation>
    </message>
    <message>
        <source>Live, {0} touches were accepted with a mean error of {1} mm; the recording gives {2} with {3} mm, because it uses the noise of the whole recording. The recording counts.</source>
        <translation>Live wurden {0} Berührungen gezählt, mit {1} mm mittlerem Fehler; die Aufzeichnung ergibt {2} mit {3} mm, weil sie das Rauschen der ganzen Aufzeichnung verwendet. Die Aufzeichnung zählt.</translation>
    </message>
    <message>
        <source>Live, {0} touches were accepted; the recording gives {1}. The recording counts.</source>
        <translation>Live wurden {0} Berührungen gezählt; die Aufzeichnung ergibt {1}. Es zählt die Aufzeichnung.</translation>
    </message>
    <message>
        <source>Local acceleration of free fall, m/s² [9.80665 ± 0.015].</source>
        <translation>Örtliche Fallbeschleunigung, m/s² [9.80665 ± 0.015].</translation>
    </message>
    <message>
        <source>Loosen the cables and hoses, fix them to the flange, and retake the poses.</source>
        <translation>Kabel und Schläuche lockern, am Flansch befestigen und die Posen neu aufnehmen.</translation>
    </message>
    <message>
        <source>Low-pass</source>
        <translation>Tiefpass</translation>
    </message>
    <message>
        <source>Low-pass cutoff of the contact point.</source>
        <translation>Grenzfrequenz des Tiefpasses für den Kontaktpunkt.</translation>
    </message>
    <message>
        <source>LowPass.cutoff must be above 0 and below half the rate, {0} Hz, not {1} Hz</source>
        <translation>LowPass.cutoff muss über 0 und unter der halben Rate liegen, {0} Hz, nicht bei {1} Hz</translation>
    </message>
    <message>
        <source>LowPass.order must be a whole number of at least 1, not {0}</source>
        <translation>LowPass.order muss eine ganze Zahl ab 1 sein, nicht {0}</translation>
    </message>
    <message>
        <source>MQTT broker and topic</source>
        <translation>MQTT: Broker und Thema</translation>
    </message>
    <message>
        <source>Made by</source>
        <translation>Erstellt von</translation>
    </message>
    <message>
        <source>Made on {0}.</source>
        <translation>Erstellt am {0}.</translation>
    </message>
    <message>
        <source>Make the normals consistent in the CAD program, or make the outer shell.</source>
        <translation>Machen Sie die Normalen im CAD-Programm einheitlich, oder machen Sie die Außenfläche.</translation>
    </message>
    <message>
        <source>Make the outer shell before use.</source>
        <translation>Machen Sie vor dem Gebrauch die Außenfläche.</translation>
    </message>
    <message>
        <source>Mass of the sensor with its adapters, kg, and its centre of mass in the flange&apos;s frame, mm.</source>
        <translation>Masse des Sensors mit seinen Adaptern, kg, und sein Schwerpunkt im Flanschsystem, mm.</translation>
    </message>
    <message>
        <source>Maximum force</source>
        <translation>Maximale Kraft</translation>
    </message>
    <message>
        <source>Maximum torque</source>
        <translation>Maximales Moment</translation>
    </message>
    <message>
        <source>Mean error up to</source>
        <translation>Mittel bis</translation>
    </message>
    <message>
        <source>Mesh and markers seem to have another scale than the probe: check the unit of the mesh file, and measure the probe.</source>
        <translation>Netz und Marker haben anscheinend einen anderen Maßstab als die Sonde: Einheit der Netzdatei prüfen und die Sonde nachmessen.</translation>
    </message>
    <message>
        <source>Model error: {0} (95 % upper limit {1}; the touches count as {2} independent one{3}).</source>
        <translation>Modellfehler: {0} (obere 95-%-Grenze {1}; die Berührungen zählen wie {2} unabhängige).{3}</translation>
    </message>
    <message>
        <source>Model of the force/torque sensor; for the report.</source>
        <translation>Modell des Kraft-Momenten-Sensors; für den Bericht.</translation>
    </message>
    <message>
        <source>Model of the sensor.</source>
        <translation>Modell des Sensors.</translation>
    </message>
    <message>
        <source>More of it is damaged in the same way.</source>
        <translation>Weiteres darin ist auf dieselbe Weise beschädigt.</translation>
    </message>
    <message>
        <source>More poses will not help: the error is not noise.</source>
        <translation>Mehr Posen helfen nicht: Der Fehler ist kein Rauschen.</translation>
    </message>
    <message>
        <source>More than two facets meet at an edge (edges: {0}), so inside and outside cannot be told apart there. Keep only the outer shell.</source>
        <translation>Mehr als zwei Facetten treffen sich an einer Kante (Kanten: {0}), deshalb sind dort innen und außen nicht zu unterscheiden. Behalten Sie nur die Außenhülle.</translation>
    </message>
    <message>
        <source>More than two facets meet at {0}, so inside and outside cannot be told apart there: walls are joined, or bodies touch along an edge. {1}</source>
        <translation>Mehr als zwei Facetten treffen sich an einer Kante ({0}), deshalb sind dort innen und außen nicht zu unterscheiden: Wände sind verbunden, oder Körper berühren sich entlang einer Kante. {1}</translation>
    </message>
    <message>
        <source>Most likely {0}: {1} of {2} rows ({3} %) are then plausible. {4}{5}</source>
        <translation>Am wahrscheinlichsten: {0}. Dann sind {1} von {2} Zeilen ({3} %) plausibel. {4}{5}</translation>
    </message>
    <message>
        <source>Motion of the phantom.</source>
        <translation>Bewegung des Phantoms.</translation>
    </message>
    <message>
        <source>MountBelief.{0}: {1} is not above 0 and at most {2} (m, rad).</source>
        <translation>MountBelief.{0}: {1} ist nicht über 0 und höchstens {2} (m, rad).</translation>
    </message>
    <message>
        <source>Moving slowly, or drifting: {0}/s.</source>
        <translation>Bewegt sich langsam oder driftet: {0}/s.</translation>
    </message>
    <message>
        <source>Moving: the sensor turns.</source>
        <translation>Bewegt sich: Der Sensor dreht sich.</translation>
    </message>
    <message>
        <source>Moving: {0}.</source>
        <translation>In Bewegung: {0}.</translation>
    </message>
    <message>
        <source>Multiply {0} by -1, or set the sign in the driver.</source>
        <translation>{0} mit -1 multiplizieren, oder das Vorzeichen im Treiber setzen.</translation>
    </message>
    <message>
        <source>Multiply {0}.</source>
        <translation>Multiplizieren Sie {0}.</translation>
    </message>
    <message>
        <source>N*m: check whether they were N*mm.</source>
        <translation>N*m: Waren es N*mm?</translation>
    </message>
    <message>
        <source>N: pull of an operator&apos;s hand at the handle while the probe is pressed, root mean square.</source>
        <translation>N: eine Hand zieht am Griff, während die Sonde gedrückt wird, quadratisches Mittel.</translation>
    </message>
    <message>
        <source>N: pull of the cable when the tool is turned away from the cable&apos;s free hanging direction.</source>
        <translation>N: Zug des Kabels, wenn das Werkzeug von der freien Hängerichtung des Kabels weggedreht ist.</translation>
    </message>
    <message>
        <source>NOT READY: </source>
        <translation>NICHT BEREIT: </translation>
    </message>
    <message>
        <source>NOT verified</source>
        <translation>NICHT überprüft</translation>
    </message>
    <message>
        <source>Name of frame S in the robot description.</source>
        <translation>Name des Koordinatensystems S in der Roboterbeschreibung.</translation>
    </message>
    <message>
        <source>Name of frame W in the robot description.</source>
        <translation>Name des Koordinatensystems W in der Roboterbeschreibung.</translation>
    </message>
    <message>
        <source>Name of the sensor in the robot description&apos;s ros2_control tag, for ros2.yaml.</source>
        <translation>Name des Sensors im ros2_control-Element der Roboterbeschreibung, für ros2.yaml.</translation>
    </message>
    <message>
        <source>Name the columns {0}.</source>
        <translation>Benennen Sie die Spalten {0}.</translation>
    </message>
    <message>
        <source>Name the columns {0}: {1}.</source>
        <translation>Benennen Sie die Spalten {0}: {1}.</translation>
    </message>
    <message>
        <source>Negate all six channels: the file must contain the force of the tissue on the probe.</source>
        <translation>Kehren Sie alle sechs Kanäle um: Die Datei muss die Kraft des Gewebes auf die Sonde enthalten.</translation>
    </message>
    <message>
        <source>Neighbouring facets disagree about which side is outside. </source>
        <translation>Benachbarte Facetten widersprechen sich darin, welche Seite außen ist. </translation>
    </message>
    <message>
        <source>Neighbouring facets disagree about which side is outside. Contacts on flipped facets are missed, or found on the far side. Make the normals consistent in the CAD program.</source>
        <translation>Benachbarte Facetten widersprechen sich darin, welche Seite außen ist. Kontakte auf den umgedrehten Facetten werden übersehen oder auf der Gegenseite gefunden. Machen Sie die Normalen im CAD-Programm einheitlich.</translation>
    </message>
    <message>
        <source>Neighbouring samples are correlated (the sensor filters): {0} samples count as one, and the noise of means is increased accordingly.</source>
        <translation>Benachbarte Messwerte sind korreliert (der Sensor filtert): {0} Messwerte zählen als einer, und das Rauschen von Mittelwerten wird entsprechend erhöht.</translation>
    </message>
    <message>
        <source>Neither a known weight nor a known touch was checked: a wrong sign, unit or scale of the sensor would go unnoticed. Check one of them.</source>
        <translation>Weder ein bekanntes Gewicht noch ein bekannter Druckpunkt wurde geprüft: Ein falsches Vorzeichen, eine falsche Einheit oder Skala des Sensors bliebe unbemerkt. Eines von beiden prüfen.</translation>
    </message>
    <message>
        <source>New MCAP file for the contacts.</source>
        <translation>Neue MCAP-Datei für die Kontakte.</translation>
    </message>
    <message>
        <source>New file for the lines; - is standard output.</source>
        <translation>Neue Datei für die Zeilen; - ist die Standardausgabe.</translation>
    </message>
    <message>
        <source>Next: {0}. {1}</source>
        <translation>Als Nächstes: {0}. {1}</translation>
    </message>
    <message>
        <source>No action needed.</source>
        <translation>Nichts zu tun.</translation>
    </message>
    <message>
        <source>No angle is larger than {0}°: if they are in rad, pass --radians.</source>
        <translation>Kein Winkel ist größer als {0}°: Falls sie in rad sind, geben Sie --radians an.</translation>
    </message>
    <message>
        <source>No cause that is known here explains so much: check the units, the gains and the signs of the sensor, its mount, and what else touched the probe.</source>
        <translation>Keine hier bekannte Ursache erklärt so viel: Einheiten, Verstärkungen und Vorzeichen des Sensors und seine Halterung prüfen, und was die Sonde sonst berührt hat.</translation>
    </message>
    <message>
        <source>No channel has changed for {0} samples: the sensor hangs, or is disconnected from its box. Switch it off and on.</source>
        <translation>Kein Kanal hat sich über {0} Messwerte geändert: Der Sensor hängt, oder er ist nicht mit seiner Box verbunden. Schalten Sie ihn aus und ein.</translation>
    </message>
    <message>
        <source>No clocking direction was given, so the mesh is turned about the axis as little as possible. Pick a point or an edge to fix it.</source>
        <translation>Für die Drehung um die Achse ist keine Richtung angegeben: Das Netz wird so wenig wie möglich um sie gedreht. Wählen Sie einen Punkt oder eine Kante, um sie festzulegen.</translation>
    </message>
    <message>
        <source>No common mistake explains it. Check that the right point was pressed, that nothing else touched the probe, and how the mesh is aligned with the sensor.</source>
        <translation>Kein üblicher Fehler erklärt es. Prüfen, ob der richtige Punkt gedrückt wurde, ob sonst nichts die Sonde berührt hat und wie das Netz zum Sensor ausgerichtet ist.</translation>
    </message>
    <message>
        <source>No device is open, so nothing can be recorded: choose devices first.</source>
        <translation>Kein Gerät ist geöffnet, also gibt es nichts aufzuzeichnen: Wählen Sie zuerst Geräte.</translation>
    </message>
    <message>
        <source>No message on {0} gives a pose of the flange{1}{2}</source>
        <translation>Nichts auf {0} gibt eine Pose des Flansches{1}{2}</translation>
    </message>
    <message>
        <source>No output is chosen: choose one.</source>
        <translation>Es ist keine Ausgabe gewählt: Wählen Sie eine.</translation>
    </message>
    <message>
        <source>No pose arrives with the samples, so the weight cannot be subtracted. Check the robot&apos;s connection; touches count again once it is back.</source>
        <translation>Mit den Messwerten kommt keine Pose, deshalb kann das Gewicht nicht abgezogen werden. Prüfen Sie die Verbindung zum Roboter; danach zählen Berührungen wieder.</translation>
    </message>
    <message>
        <source>No poses arrive, so the orientation is unknown: check the robot&apos;s address and cable. They resume automatically.</source>
        <translation>Es kommen keine Posen, die Orientierung ist unbekannt: Prüfen Sie Adresse und Kabel des Roboters. Es geht von selbst weiter.</translation>
    </message>
    <message>
        <source>No priority regions: all candidates are equal. That is fine for most probes.</source>
        <translation>Keine bevorzugten Regionen: Alle Kandidaten sind gleich. Für die meisten Sonden ist das in Ordnung.</translation>
    </message>
    <message>
        <source>No region is chosen: add one, or choose one in the list.</source>
        <translation>Keine Region ist gewählt: Fügen Sie eine hinzu, oder wählen Sie eine in der Liste.</translation>
    </message>
    <message>
        <source>No sample is readable.</source>
        <translation>Kein Messwert ist lesbar.</translation>
    </message>
    <message>
        <source>No samples arrive from the sensor: check its cable and step 1, Devices, then start again.</source>
        <translation>Vom Sensor kommen keine Messwerte: Prüfen Sie sein Kabel und Schritt 1, Geräte, dann starten Sie noch einmal.</translation>
    </message>
    <message>
        <source>No sensor is open: connect one in step 1, Devices, then start again.</source>
        <translation>Kein Sensor ist geöffnet: Verbinden Sie einen in Schritt 1, Geräte, dann starten Sie noch einmal.</translation>
    </message>
    <message>
        <source>No shift within {0} s explains the forces: check that this robot holds the sensor.</source>
        <translation>Keine Verschiebung bis {0} s erklärt die Kräfte: Prüfen Sie, ob dieser Roboter den Sensor trägt.</translation>
    </message>
    <message>
        <source>No single convention mistake explains the data: {0} (odds of another cause: {1}). Look for two mistakes at once, a pulling cable, drift, {2}or poses in which something was touched.</source>
        <translation>Kein einzelner Konventionsfehler erklärt die Daten: {0} (Chancen einer anderen Ursache: {1}). Suchen Sie nach zwei Fehlern zugleich, einem ziehenden Kabel, Drift, {2}oder Posen, in denen etwas berührt wurde.</translation>
    </message>
    <message>
        <source>No single touch of the probe explains most of the wrenches: {0} of {1} rows tried are plausible. Median arm (torque over force): {2} m; the probe reaches {3} m. The line of force misses the probe by {4} mm (median). Smallest force in the file: {5} N.</source>
        <translation>Die meisten Messwerte erklärt keine einzelne Berührung der Sonde: {0} von {1} geprüften Zeilen sind plausibel. Mittlerer Hebelarm (Drehmoment durch Kraft): {2} m; die Sonde reicht {3} m weit. Die Kraftlinie verfehlt die Sonde um {4} mm (Median). Kleinste Kraft in der Datei: {5} N.</translation>
    </message>
    <message>
        <source>No single touch on the probe explains the press.</source>
        <translation>Keine einzelne Berührung der Sonde erklärt den Druck.</translation>
    </message>
    <message>
        <source>No steady press: |F| reaches {0} N. Press with 5 to 15 N for a second, then let go. If the press was harder, the forces are not in N: check them with a known weight.</source>
        <translation>Kein ruhiger Druck: |F| erreicht {0} N. Eine Sekunde lang mit 5 bis 15 N drücken, dann loslassen. War der Druck stärker, sind die Kräfte nicht in N: mit einem bekannten Gewicht prüfen.</translation>
    </message>
    <message>
        <source>None of the usual mistakes makes most of them plausible (torques in N·mm, reversed forces, a mount turned by right angles, uncompensated weight). Check the position in --place, and that nothing else touches or pulls the probe: two touches at once, or a cable, look like this.</source>
        <translation>Keiner der üblichen Fehler macht die meisten plausibel (Drehmomente in N·mm, umgekehrte Kräfte, um rechte Winkel gedrehte Halterung, nicht kompensiertes Gewicht). Die Lage in --place prüfen, und dass sonst nichts die Sonde berührt oder an ihr zieht: Zwei Berührungen zugleich oder ein Kabel sehen so aus.</translation>
    </message>
    <message>
        <source>Not captured: {0}.</source>
        <translation>Nicht aufgenommen: {0}.</translation>
    </message>
    <message>
        <source>Not passed. {0} Correct the cause, then verify again.</source>
        <translation>Nicht bestanden. {0} Beheben Sie die Ursache, und verifizieren Sie dann neu.</translation>
    </message>
    <message>
        <source>Not passed: {0}. Verify again.</source>
        <translation>Nicht bestanden: {0}. Prüfen Sie erneut.</translation>
    </message>
    <message>
        <source>Not ready yet</source>
        <translation>Noch nicht bereit</translation>
    </message>
    <message>
        <source>Note</source>
        <translation>Hinweis</translation>
    </message>
    <message>
        <source>Nothing was recorded for {0} s after {1} s, or the clock was set forward: nothing is paired across.</source>
        <translation>Nach {1} s wurde {0} s lang nichts aufgezeichnet, oder die Uhr wurde vorgestellt: Darüber hinweg wird nichts gepaart.</translation>
    </message>
    <message>
        <source>Number of the sensor&apos;s calibration certificate; for the report.</source>
        <translation>Nummer des Kalibrierscheins des Sensors; für den Bericht.</translation>
    </message>
    <message>
        <source>Number of the weight&apos;s certificate.</source>
        <translation>Nummer des Zertifikats des Gewichts.</translation>
    </message>
    <message>
        <source>Odds of a touch in the region of highest priority relative to elsewhere; each further region has a tenth of it, at least 10.</source>
        <translation>Chance einer Berührung in der Region mit der höchsten Priorität gegenüber anderswo; jede weitere Region hat ein Zehntel davon, mindestens 10.</translation>
    </message>
    <message>
        <source>Odds that the first surface on the line of force is touched rather than one behind it.</source>
        <translation>Chance, dass die erste Fläche auf der Kraftlinie berührt wird und nicht eine dahinter.</translation>
    </message>
    <message>
        <source>On held-out touches the fitted mount errs by {0}, the first mount by {1}; on its own touches the fit errs by {2}; noise and placement alone give {3}.</source>
        <translation>Bei Berührungen, die neu für sie sind, liegt die angepasste Montage um {0} daneben, die anfängliche um {1}; bei ihren eigenen Berührungen liegt die Anpassung um {2} daneben; Rauschen und Platzierung allein ergeben {3}.</translation>
    </message>
    <message>
        <source>Only contacts from here on, s after the first sample.</source>
        <translation>Nur Kontakte ab hier, s nach dem ersten Messwert.</translation>
    </message>
    <message>
        <source>Only contacts up to here, s after the first sample.</source>
        <translation>Nur Kontakte bis hier, s nach dem ersten Messwert.</translation>
    </message>
    <message>
        <source>Only contacts with this force or less, N.</source>
        <translation>Nur Kontakte mit höchstens dieser Kraft, N.</translation>
    </message>
    <message>
        <source>Only contacts with this force or more, N.</source>
        <translation>Nur Kontakte mit mindestens dieser Kraft, N.</translation>
    </message>
    <message>
        <source>Only origin and date differ.</source>
        <translation>Nur Herkunft und Datum weichen ab.</translation>
    </message>
    <message>
        <source>Only {0} of {1} accepted touches have a reference force: check that its times use the recording&apos;s clock.</source>
        <translation>Nur {0} von {1} gezählten Berührungen haben eine Kraft der Referenz: Prüfen Sie, ob deren Zeiten von der Uhr der Aufzeichnung sind.</translation>
    </message>
    <message>
        <source>Only {0} of {1} poses agree, which can be chance with fifteen unknowns. Either most captures were disturbed (retake them), or the orientations follow another convention than declared.</source>
        <translation>Nur {0} von {1} Posen stimmen überein, was bei fünfzehn Unbekannten Zufall sein kann. Entweder waren die meisten Aufnahmen gestört (nehmen Sie sie neu auf), oder die Orientierungen folgen einer anderen Konvention als angegeben.</translation>
    </message>
    <message>
        <source>Only {0} of {1} samples per second are handled, and this program uses {2} of a processor core: it is probably too slow here, not the sensor. Use fewer outputs, or stop other programs.</source>
        <translation>Nur {0} von {1} Messwerten je Sekunde werden verarbeitet, und dieses Programm nutzt {2} eines Prozessorkerns: Wahrscheinlich ist es hier zu langsam, nicht der Sensor. Nutzen Sie weniger Ausgaben, oder beenden Sie andere Programme.</translation>
    </message>
    <message>
        <source>Only {0} of {1} touches agree with one mount. Check the order of the markers, the sign of the wrenches and the mesh.</source>
        <translation>Nur {0} von {1} Berührungen passen zu derselben Montage. Prüfen Sie die Reihenfolge der Marker, das Vorzeichen der Kräfte und Momente und das Netz.</translation>
    </message>
    <message>
        <source>OpenIGTLink (3D Slicer)</source>
        <translation>OpenIGTLink (3D Slicer)</translation>
    </message>
    <message>
        <source>OpenIGTLink tracker</source>
        <translation>OpenIGTLink-Tracker</translation>
    </message>
    <message>
        <source>OpenIGTLink: the name {0} is too long: {1} letters at most.</source>
        <translation>OpenIGTLink: Der Name {0} ist zu lang: höchstens {1} Buchstaben.</translation>
    </message>
    <message>
        <source>OpenIGTLink: the server sends several bodies ({0}): add ?device=NAME to the address.</source>
        <translation>OpenIGTLink: Der Server sendet mehrere Körper ({0}): Hängen Sie ?device=NAME an die Adresse an.</translation>
    </message>
    <message>
        <source>OpenIGTLink: {0} of {1} cannot be written ({2}): use ASCII names.</source>
        <translation>OpenIGTLink: {0} von {1} lässt sich nicht schreiben ({2}): Verwenden Sie Namen in ASCII.</translation>
    </message>
    <message>
        <source>Optional: paint where contacts are preferred, or continue with Verify.</source>
        <translation>Nicht nötig: Malen Sie, wo Kontakte bevorzugt werden, oder machen Sie mit Verifizieren weiter.</translation>
    </message>
    <message>
        <source>Or the specified noise is {0} times too large: weigh the tool to be sure.</source>
        <translation>Oder das angegebene Rauschen ist {0}-mal zu groß: Wiegen Sie das Werkzeug, um sicher zu sein.</translation>
    </message>
    <message>
        <source>Or: 95 % of contacts move by less than this.</source>
        <translation>Oder: 95 % der Kontakte verschieben sich um weniger als dies.</translation>
    </message>
    <message>
        <source>Or: largest distance from the outer surface.</source>
        <translation>Oder: größter Abstand von der Außenfläche.</translation>
    </message>
    <message>
        <source>Orientation is rx,ry,rz: angles about these axes, in the order of the columns; xyz: fixed axes, ZYX: rotating axes.</source>
        <translation>Die Orientierung ist rx,ry,rz: Winkel um diese Achsen, in der Reihenfolge der Spalten; xyz: feste Achsen, ZYX: mitdrehende Achsen.</translation>
    </message>
    <message>
        <source>Orientation is rx,ry,rz: axis times angle.</source>
        <translation>Die Orientierung ist rx,ry,rz: Achse mal Winkel.</translation>
    </message>
    <message>
        <source>Orientation is that of a robot&apos;s flange, by joints j1, j2, ...: elfin3, or a URDF or MJCF file.</source>
        <translation>Die Ausrichtung ist die des Roboterflansches, aus den Gelenken j1, j2, ...: elfin3 oder eine URDF- oder MJCF-Datei.</translation>
    </message>
    <message>
        <source>Orientations and readings are shifted by one row: each reading belongs to the {0} row&apos;s orientation</source>
        <translation>Orientierungen und Messwerte sind um eine Zeile verschoben: Jeder Messwert gehört zur Orientierung einer Nachbarzeile ({0})</translation>
    </message>
    <message>
        <source>Orientations are those of the flange, and the rotation of the sensor on it is unknown.</source>
        <translation>Die Orientierungen sind die des Flansches, und wie der Sensor darauf gedreht ist, ist unbekannt.</translation>
    </message>
    <message>
        <source>Orientations are those of the flange; the sensor is turned on it by these angles about the fixed axes x, then y, then z of the flange, degrees.</source>
        <translation>Die Orientierungen sind die des Flansches, und der Sensor ist darauf um diese Winkel gedreht, um die festen Achsen x, dann y, dann z des Flansches, Grad.</translation>
    </message>
    <message>
        <source>Orientations turn world into sensor components (R_SW).</source>
        <translation>Die Orientierungen drehen Weltkomponenten in Sensorkomponenten (R_SW).</translation>
    </message>
    <message>
        <source>Outside every region</source>
        <translation>Außerhalb aller Regionen</translation>
    </message>
    <message>
        <source>Outside the regions, which does not count for the choice, the {0} is {1} mm; noise alone gives {2} mm.</source>
        <translation>Außerhalb der Regionen, was nicht entscheidet, ist der Fehler ({0}) {1} mm, wo Rauschen {2} mm ergibt.</translation>
    </message>
    <message>
        <source>Painted and applied to the probe.</source>
        <translation>Gemalt und auf die Sonde angewendet.</translation>
    </message>
    <message>
        <source>Painted. The regions are applied when the probe is prepared.</source>
        <translation>Gemalt. Die Regionen werden angewendet, wenn die Sonde vorbereitet wird.</translation>
    </message>
    <message>
        <source>Parts of the 3MF file state another unit ({0}) than its build ({1}), whose unit was used for all: check their size.</source>
        <translation>Teile der 3MF-Datei nennen eine andere Einheit ({0}) als ihr Aufbau ({1}), dessen Einheit für alle gilt: Prüfen Sie ihre Größe.</translation>
    </message>
    <message>
        <source>Parts of the DAE file that are damaged or of an unknown kind were left out (parts: {0}).</source>
        <translation>Teile der DAE-Datei, die beschädigt oder von unbekannter Art sind, wurden weggelassen (Teile: {0}).</translation>
    </message>
    <message>
        <source>Parts of the glTF scene are attached to a skeleton; they were read in their rest pose.</source>
        <translation>Teile der glTF-Szene hängen an einem Skelett; sie wurden in seiner Ruhelage gelesen.</translation>
    </message>
    <message>
        <source>Pass --inverse, or export R_WS.</source>
        <translation>Geben Sie --inverse an, oder exportieren Sie R_WS.</translation>
    </message>
    <message>
        <source>Pass --radians.</source>
        <translation>Geben Sie --radians an.</translation>
    </message>
    <message>
        <source>Pass {0}, and {1} --radians.</source>
        <translation>Übergeben Sie {0}; --radians: {1}.</translation>
    </message>
    <message>
        <source>Pass {0}.</source>
        <translation>Übergeben Sie {0}.</translation>
    </message>
    <message>
        <source>Passed</source>
        <translation>Bestanden</translation>
    </message>
    <message>
        <source>Passed: {0}.</source>
        <translation>Bestanden: {0}.</translation>
    </message>
    <message>
        <source>Payload</source>
        <translation>Nutzlast</translation>
    </message>
    <message>
        <source>Per marker</source>
        <translation>Je Marker</translation>
    </message>
    <message>
        <source>Period of that motion, s.</source>
        <translation>Periode dieser Bewegung, s.</translation>
    </message>
    <message>
        <source>Polygons cross themselves, so their triangles overlap (polygons: {0}).</source>
        <translation>Vielecke schneiden sich selbst, deshalb überlappen ihre Dreiecke (Vielecke: {0}).</translation>
    </message>
    <message>
        <source>Polygons of fewer than three corners were left out (polygons: {0}).</source>
        <translation>Vielecke mit weniger als drei Ecken wurden ausgelassen (Vielecke: {0}).</translation>
    </message>
    <message>
        <source>Pose of the mesh in S: mm, and degrees about the fixed axes x, then y, then z. Left out: the mesh stays in its own frame.</source>
        <translation>Lage des Netzes in S: mm, und Grad um die festen Achsen x, dann y, dann z. Ohne Angabe bleibt das Netz in seinem eigenen Koordinatensystem.</translation>
    </message>
    <message>
        <source>PoseNoise.orientation: give a finite angle of at least 0, rad, not {0}</source>
        <translation>PoseNoise.orientation: Geben Sie einen endlichen Winkel von mindestens 0 an, rad, nicht {0}</translation>
    </message>
    <message>
        <source>PoseNoise.{0}: give one or three finite numbers above 0, {1}, not {2}</source>
        <translation>PoseNoise.{0}: Geben Sie eine oder drei endliche Zahlen über 0 an, {1}, nicht {2}</translation>
    </message>
    <message>
        <source>Possible, with a probability of {0} %: {1}</source>
        <translation>Möglich, mit einer Wahrscheinlichkeit von {0} %: {1}</translation>
    </message>
    <message>
        <source>Prepare the mesh again with more facets.</source>
        <translation>Bereiten Sie das Netz noch einmal mit mehr Facetten vor.</translation>
    </message>
    <message>
        <source>Prepare the probe first.</source>
        <translation>Bereiten Sie zuerst die Sonde vor.</translation>
    </message>
    <message>
        <source>Prepare the probe&apos;s mesh.</source>
        <translation>Bereiten Sie das Netz der Sonde vor.</translation>
    </message>
    <message>
        <source>Prepared on {0}.{1}</source>
        <translation>Vorbereitet am {0}.{1}</translation>
    </message>
    <message>
        <source>Preparing the probe.</source>
        <translation>Die Sonde wird vorbereitet.</translation>
    </message>
    <message>
        <source>Press a known point of the probe.</source>
        <translation>Auf einen bekannten Punkt der Sonde drücken.</translation>
    </message>
    <message>
        <source>Press a point on the side of the probe, at least {0} mm from the sensor&apos;s axis.</source>
        <translation>Einen Punkt an der Seite der Sonde drücken, mindestens {0} mm neben der Sensorachse.</translation>
    </message>
    <message>
        <source>Press along one axis of the flange: a turned mount shows in the force&apos;s direction.</source>
        <translation>Entlang einer Achse des Flansches drücken: Eine verdrehte Montage zeigt sich an der Richtung der Kraft.</translation>
    </message>
    <message>
        <source>Press harder with something thin, and hit the point to within {0} mm.</source>
        <translation>Fester und mit etwas Dünnem drücken und den Punkt auf {0} mm genau treffen.</translation>
    </message>
    <message>
        <source>Press on this side: a channel at its limit reads no more.</source>
        <translation>Auf diese Seite drücken: Ein Kanal an seiner Grenze zeigt nicht mehr an.</translation>
    </message>
    <message>
        <source>Press the point with 5 to 15 N, hold for a second, then let go.</source>
        <translation>Mit 5 bis 15 N auf den Punkt drücken, eine Sekunde halten, dann loslassen.</translation>
    </message>
    <message>
        <source>Press the tool with a finger, and check the directions of the forces and torques.</source>
        <translation>Drücken Sie mit einem Finger auf das Werkzeug, und prüfen Sie die Richtungen der Kräfte und Momente.</translation>
    </message>
    <message>
        <source>Press with a tip that turns freely and does not grip, or at smaller angles: the torque at the contact is not about the surface normal.</source>
        <translation>Drücken Sie mit einer Spitze, die sich frei dreht und nicht haftet, oder unter kleineren Winkeln: Das Moment am Kontakt wirkt nicht um die Normale der Oberfläche.</translation>
    </message>
    <message>
        <source>Principal axes of the {0}: the longest (rms {1} mm) along z, the middle ({2}) along x, the shortest ({3}) along y; the lowest point at z = {4} mm, the centroid on the axis.</source>
        <translation>Hauptachsen ({0}): die längste (rms {1} mm) entlang z, die mittlere ({2}) entlang x, die kürzeste ({3}) entlang y; der tiefste Punkt bei z = {4} mm, der Schwerpunkt auf der Achse.</translation>
    </message>
    <message>
        <source>Prior.mass_range: {0} is no range of masses: give (low, high), kg.</source>
        <translation>Prior.mass_range: {0} ist kein Bereich von Massen: Geben Sie (kleinste, größte) in kg an.</translation>
    </message>
    <message>
        <source>Prior.mass_sigma without Prior.mass: give the mass as weighed, kg, too.</source>
        <translation>Prior.mass_sigma ohne Prior.mass: Geben Sie auch die gewogene Masse in kg an.</translation>
    </message>
    <message>
        <source>Prior.{0}: give three finite numbers that are not all 0, not {1}.</source>
        <translation>Prior.{0}: Geben Sie drei endliche Zahlen an, die nicht alle 0 sind, nicht {1}.</translation>
    </message>
    <message>
        <source>Prior.{0}: {1} is not above {2} and at most {3} ({4}).</source>
        <translation>Prior.{0}: {1} muss größer als {2} und höchstens {3} sein ({4}).</translation>
    </message>
    <message>
        <source>Probe</source>
        <translation>Sonde</translation>
    </message>
    <message>
        <source>Publish contacts to this MQTT broker.</source>
        <translation>Kontakte an diesen MQTT-Broker senden.</translation>
    </message>
    <message>
        <source>Quantity to show.</source>
        <translation>Gezeigte Größe.</translation>
    </message>
    <message>
        <source>RDT: counts per unit must be finite and above 0, not {0}: read them from the sensor&apos;s configuration page.</source>
        <translation>RDT: Zählschritte pro Einheit müssen endlich und größer als 0 sein, nicht {0}: auf der Konfigurationsseite des Sensors ablesen.</translation>
    </message>
    <message>
        <source>ROS 2, DDS domain</source>
        <translation>ROS 2, DDS-Domäne</translation>
    </message>
    <message>
        <source>ROS does not take that: {0}.</source>
        <translation>ROS nimmt das nicht an: {0}.</translation>
    </message>
    <message>
        <source>R_ES must be a (3, 3) rotation, the sensor&apos;s axes in the flange as columns, not {0}</source>
        <translation>R_ES muss eine Rotation (3, 3) sein, mit den Achsen des Sensors im Flansch als Spalten, nicht {0}</translation>
    </message>
    <message>
        <source>R_WS is a reflection (determinant -1): one axis has the wrong sign</source>
        <translation>R_WS ist eine Spiegelung (Determinante -1): Eine Achse hat das falsche Vorzeichen</translation>
    </message>
    <message>
        <source>R_WS is not a rotation: its columns are not unit vectors at right angles</source>
        <translation>R_WS ist keine Rotation: Ihre Spalten sind keine rechtwinkligen Vektoren der Länge 1</translation>
    </message>
    <message>
        <source>R_WS must be a finite (3, 3) rotation, not shape {0} with {1}...</source>
        <translation>R_WS muss eine endliche Rotation (3, 3) sein, nicht die Form {0} mit {1}...</translation>
    </message>
    <message>
        <source>R_WS: give (3, 3) or one (3, 3) for each sample, not shape {0}</source>
        <translation>R_WS: Geben Sie (3, 3) an oder ein (3, 3) für jeden Messwert, nicht die Form {0}</translation>
    </message>
    <message>
        <source>RawOrientations.values: give finite numbers of shape (n, {0}), columns {1}, not shape {2}.</source>
        <translation>RawOrientations.values: Geben Sie endliche Zahlen der Form (n, {0}) an, Spalten {1}, nicht der Form {2}.</translation>
    </message>
    <message>
        <source>Readings</source>
        <translation>Messwerte</translation>
    </message>
    <message>
        <source>Readings and contacts will be lost: use fewer outputs, or a lower rate.</source>
        <translation>Messwerte und Kontakte werden verloren gehen: weniger Ausgaben oder eine niedrigere Rate wählen.</translation>
    </message>
    <message>
        <source>Readings per second.</source>
        <translation>Messwerte pro Sekunde.</translation>
    </message>
    <message>
        <source>Realign the probe with touches on all of its sides. If the refined alignment helps, it is enough.</source>
        <translation>Richten Sie die Sonde mit Berührungen auf allen ihren Seiten neu aus. Wenn die verfeinerte Ausrichtung hilft, genügt sie.</translation>
    </message>
    <message>
        <source>Reason ambiguous unless the likeliest place is this many times likelier than any other.</source>
        <translation>Grund „ambiguous“, wenn der wahrscheinlichste Ort nicht um diesen Faktor wahrscheinlicher ist als jeder andere.</translation>
    </message>
    <message>
        <source>Reason ambiguous when another likely place is this far away, or 4.5 standard deviations if that is more.</source>
        <translation>Grund „ambiguous“, wenn ein anderer wahrscheinlicher Ort so weit entfernt ist, oder 4,5 Standardabweichungen, wenn das mehr ist.</translation>
    </message>
    <message>
        <source>Reason implausible if a touch leaves a misfit that chance alone reaches with at most this probability.</source>
        <translation>Grund „implausible“, wenn eine Berührung eine Abweichung lässt, die der Zufall höchstens mit dieser Wahrscheinlichkeit erreicht.</translation>
    </message>
    <message>
        <source>Reason low_force below this force.</source>
        <translation>Grund „low_force“ unterhalb dieser Kraft.</translation>
    </message>
    <message>
        <source>Reason saturated when a channel reaches this.</source>
        <translation>Grund „saturated“, wenn ein Kanal das erreicht.</translation>
    </message>
    <message>
        <source>Reason stale when a sample is older; when tracking, a longer gap starts anew.</source>
        <translation>Grund „stale“, wenn ein Messwert älter ist; beim Verfolgen beginnt nach einer längeren Lücke alles neu.</translation>
    </message>
    <message>
        <source>Reason tangential beyond this angle to the normal.</source>
        <translation>Grund „tangential“ jenseits dieses Winkels zur Normalen.</translation>
    </message>
    <message>
        <source>Reason uncertain when the largest standard deviation of the point is more than this. 0: not asked.</source>
        <translation>Grund „uncertain“, wenn die größte Standardabweichung des Punktes diesen Wert übersteigt. 0: nicht verlangt.</translation>
    </message>
    <message>
        <source>Recalibrate bias and weight with poses tilted about two axes, with the sensor warm and the cable routed as in use.</source>
        <translation>Kalibrieren Sie Nullpunktfehler und Gewicht neu, mit um zwei Achsen geneigten Posen, warmem Sensor und dem Kabel wie im Gebrauch.</translation>
    </message>
    <message>
        <source>Recalibrate bias and weight with poses tilted about two axes. Drift is already subtracted: a warmer sensor does not help.</source>
        <translation>Kalibrieren Sie Nullpunkt und Gewicht neu, mit um zwei Achsen geneigten Posen. Die Drift ist schon abgezogen: Ein wärmerer Sensor hilft nicht.</translation>
    </message>
    <message>
        <source>Record the wrench in the sensor&apos;s frame, or turn it by the transpose of R_WS.</source>
        <translation>Kraft und Drehmoment im Koordinatensystem des Sensors aufnehmen oder mit der Transponierten von R_WS drehen.</translation>
    </message>
    <message>
        <source>Recording a calibration.</source>
        <translation>Eine Kalibrierung wird aufgezeichnet.</translation>
    </message>
    <message>
        <source>Recording a verification.</source>
        <translation>Eine Überprüfung wird aufgezeichnet.</translation>
    </message>
    <message>
        <source>Recording {0} started: {1}.</source>
        <translation>Aufzeichnung {0} begonnen: {1}.</translation>
    </message>
    <message>
        <source>Records were out of order; their order was restored from their hashes.</source>
        <translation>Einträge waren in falscher Reihenfolge; anhand ihrer Hashwerte ist sie wiederhergestellt.</translation>
    </message>
    <message>
        <source>Refuse contacts outside every region of the mesh.</source>
        <translation>Kontakte außerhalb aller Regionen des Netzes ablehnen.</translation>
    </message>
    <message>
        <source>Regions</source>
        <translation>Regionen</translation>
    </message>
    <message>
        <source>Regions are painted but not applied to the probe yet: apply them.</source>
        <translation>Regionen sind gemalt, aber noch nicht auf die Sonde angewendet: Wenden Sie sie an.</translation>
    </message>
    <message>
        <source>Rejected: do not use</source>
        <translation>Abgelehnt: nicht benutzen</translation>
    </message>
    <message>
        <source>Repeat the first pose at the end: only a bias that changes reads differently there.</source>
        <translation>Die erste Pose am Ende wiederholen: Nur bei einem veränderlichen Nullpunkt weicht der Messwert dort ab.</translation>
    </message>
    <message>
        <source>Replace probe_tool by the name of your tooldata. These numbers are in the wrist frame: do not use them as a loaddata for GripLoad, which is in the tool frame.</source>
        <translation>Ersetzen Sie probe_tool durch den Namen Ihres tooldata. Die Werte gelten im Handgelenksystem: Verwenden Sie sie nicht als loaddata für GripLoad, das im Werkzeugsystem gilt.</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>Bericht</translation>
    </message>
    <message>
        <source>Responsible person.</source>
        <translation>Verantwortliche Person.</translation>
    </message>
    <message>
        <source>Results have changed since the last export: export again.</source>
        <translation>Ergebnisse haben sich seit dem letzten Export geändert: Exportieren Sie neu.</translation>
    </message>
    <message>
        <source>Retake it</source>
        <translation>Nehmen Sie sie neu auf</translation>
    </message>
    <message>
        <source>Retake the poses with the cables off: only a cable&apos;s part goes.</source>
        <translation>Die Posen ohne Kabel neu aufnehmen: Nur der Anteil eines Kabels verschwindet.</translation>
    </message>
    <message>
        <source>Retake the poses with the cables off; if it stays, have the sensor recalibrated.</source>
        <translation>Die Posen ohne Kabel neu aufnehmen; bleibt die Abweichung, den Sensor neu kalibrieren lassen.</translation>
    </message>
    <message>
        <source>Retake them</source>
        <translation>Nehmen Sie sie neu auf</translation>
    </message>
    <message>
        <source>Review the bundle, then export it.</source>
        <translation>Sehen Sie das Bundle durch, und exportieren Sie es dann.</translation>
    </message>
    <message>
        <source>Rows after the last that the PLY header announces were left out (rows: {0}).</source>
        <translation>Zeilen nach der letzten, die der PLY-Kopf ankündigt, wurden ausgelassen (Zeilen: {0}).</translation>
    </message>
    <message>
        <source>Rows of the PLY element &apos;{0}&apos; end in numbers that the header does not list; these were left out (per row: {1}).</source>
        <translation>Zeilen des PLY-Elements &apos;{0}&apos; enden mit Zahlen, die im Kopf fehlen; sie wurden ausgelassen (je Zeile: {1}).</translation>
    </message>
    <message>
        <source>Rows that are not later than all rows before them: {0}, the first on line {1}. Their answer is stale. If recordings were joined, split them.</source>
        <translation>Zeilen, die nicht später sind als alle Zeilen davor: {0}, die erste in Zeile {1}. Sie werden mit stale beantwortet. Wenn Aufzeichnungen zusammengefügt wurden, trennen Sie sie.</translation>
    </message>
    <message>
        <source>Rows that repeat an earlier row exactly: {0}; the first is line {1}, which repeats line {2}. They count as separate poses: remove them.</source>
        <translation>Zeilen, die eine frühere genau wiederholen: {0}; die erste ist Zeile {1}, die Zeile {2} wiederholt. Sie zählen als eigene Posen: Entfernen Sie sie.</translation>
    </message>
    <message>
        <source>Run calibrate --estimate-mount, or correct the sensor&apos;s mounting.</source>
        <translation>Führen Sie calibrate --estimate-mount aus, oder berichtigen Sie die Montage des Sensors.</translation>
    </message>
    <message>
        <source>SOURCE_DATE_EPOCH is {0}: set it to whole seconds since 1970, or unset it.</source>
        <translation>SOURCE_DATE_EPOCH ist {0}: Setzen Sie es auf ganze Sekunden seit 1970, oder entfernen Sie es.</translation>
    </message>
    <message>
        <source>SRI: points per packet must be between 1 and {0}, not {1}.</source>
        <translation>SRI: Punkte pro Paket müssen zwischen 1 und {0} liegen, nicht {1}.</translation>
    </message>
    <message>
        <source>STEP tolerance</source>
        <translation>STEP-Toleranz</translation>
    </message>
    <message>
        <source>Salvaged from a damaged session.</source>
        <translation>Aus einer beschädigten Sitzung gerettet.</translation>
    </message>
    <message>
        <source>Samples</source>
        <translation>Messwerte</translation>
    </message>
    <message>
        <source>Samples arrive at {0}: check the rate and the line speed.</source>
        <translation>Rate der Messwerte: {0}. Die Rate und die Geschwindigkeit der Leitung prüfen.</translation>
    </message>
    <message>
        <source>Samples per touch after settling.</source>
        <translation>Messwerte je Berührung nach dem Beruhigen.</translation>
    </message>
    <message>
        <source>Seams are not joined: {0} of open edges lie right beside another edge. The surface looks closed there but counts as open. Export again with a finer tolerance, or make the outer shell.</source>
        <translation>Nähte sind nicht verbunden; offene Kanten liegen direkt neben anderen: {0}. Die Oberfläche sieht dort geschlossen aus, gilt aber als offen. Exportieren Sie erneut mit feinerer Toleranz, oder machen Sie die Außenfläche.</translation>
    </message>
    <message>
        <source>Seed of the bootstrap.</source>
        <translation>Startwert des Bootstraps.</translation>
    </message>
    <message>
        <source>Send each contact there as a UDP datagram.</source>
        <translation>Jeden Kontakt als UDP-Datagramm dorthin senden.</translation>
    </message>
    <message>
        <source>Sensor</source>
        <translation>Sensor</translation>
    </message>
    <message>
        <source>Separate parts are inside out (parts: {0}). Contacts on them are found on the far side. Flip their normals in the CAD program.</source>
        <translation>Einzelne Teile sind umgestülpt (Teile: {0}). Kontakte auf ihnen werden auf der Gegenseite gefunden. Drehen Sie im CAD-Programm ihre Normalen um.</translation>
    </message>
    <message>
        <source>Separate the columns with commas and write decimals with a point: {0}</source>
        <translation>Trennen Sie die Spalten mit Kommas, und schreiben Sie Dezimalzahlen mit Punkt: {0}</translation>
    </message>
    <message>
        <source>Serial number missing: the bundle would say &apos;unknown&apos;. Enter it below.</source>
        <translation>Seriennummer fehlt: Im Bundle stünde „unknown“. Geben Sie sie unten ein.</translation>
    </message>
    <message>
        <source>Serial number of the sensor.</source>
        <translation>Seriennummer des Sensors.</translation>
    </message>
    <message>
        <source>Serial number {0}.</source>
        <translation>Seriennummer {0}.</translation>
    </message>
    <message>
        <source>Serve contacts and a picture there to Foxglove.</source>
        <translation>Foxglove dort Kontakte und ein Bild anbieten.</translation>
    </message>
    <message>
        <source>Serve contacts there to OpenIGTLink clients, such as 3D Slicer.</source>
        <translation>OpenIGTLink-Programmen wie 3D Slicer dort Kontakte anbieten.</translation>
    </message>
    <message>
        <source>Set the mount to {0}° about x, y, z</source>
        <translation>Montage auf {0}° um x, y, z setzen</translation>
    </message>
    <message>
        <source>Set the payload in the controller to 0, and zero no tool, then retake the poses.</source>
        <translation>Die Nutzlast in der Steuerung auf 0 setzen, kein Werkzeug nullen und die Posen neu aufnehmen.</translation>
    </message>
    <message>
        <source>Setting the payload also zeroes the robot&apos;s own force and torque readings: set it with the robot at rest and nothing touching the tool.</source>
        <translation>Das Setzen der Nutzlast nullt auch die Kraft- und Momentenwerte des Roboters selbst: Setzen Sie sie, wenn der Roboter stillsteht und nichts das Werkzeug berührt.</translation>
    </message>
    <message>
        <source>Settling: still in about {0} s.</source>
        <translation>Beruhigt sich: ruhig in etwa {0} s.</translation>
    </message>
    <message>
        <source>Shift the orientations by one row, and remove the row that is left without one.</source>
        <translation>Verschieben Sie die Orientierungen um eine Zeile, und entfernen Sie die Zeile, die dann keine hat.</translation>
    </message>
    <message>
        <source>Single error up to</source>
        <translation>Einzeln bis</translation>
    </message>
    <message>
        <source>Size of that motion, mm or degrees.</source>
        <translation>Größe dieser Bewegung, mm oder Grad.</translation>
    </message>
    <message>
        <source>Skipped on purpose: {0}: contacts there are not verified.</source>
        <translation>Absichtlich ausgelassen: {0}: Kontakte dort sind nicht geprüft.</translation>
    </message>
    <message>
        <source>Slivers fold back onto their neighbours (facets: {0}). No action needed: together they are too small to be touched.</source>
        <translation>Splitter falten sich auf ihre Nachbarn zurück (Facetten: {0}). Nichts zu tun: Zusammen sind sie zu klein, um berührt zu werden.</translation>
    </message>
    <message>
        <source>Small holes and open seams closed: {0}.</source>
        <translation>Geschlossene kleine Löcher und offene Nähte: {0}.</translation>
    </message>
    <message>
        <source>Something pulls that stays in the room: loosen cables and hoses, fix them to the flange, and recalibrate.</source>
        <translation>Etwas zieht aus fester Richtung im Raum: Kabel und Schläuche lockern, am Flansch befestigen und neu kalibrieren.</translation>
    </message>
    <message>
        <source>Something touches the tool: {0} N more than its weight. Remove it, or move on if nothing does.</source>
        <translation>Etwas berührt das Werkzeug: {0} N mehr als sein Gewicht. Entfernen Sie es, oder gehen Sie weiter, wenn nichts es berührt.</translation>
    </message>
    <message>
        <source>Specks next to the part were left out (facets: {0}).</source>
        <translation>Flecken neben dem Teil wurden weggelassen (Facetten: {0}).</translation>
    </message>
    <message>
        <source>Speed of the tip that a controller must never exceed.</source>
        <translation>Geschwindigkeit der Spitze, die eine Regelung nie überschreiten darf.</translation>
    </message>
    <message>
        <source>Standard deviation of a force.</source>
        <translation>Standardabweichung einer Kraft.</translation>
    </message>
    <message>
        <source>Standard deviation of a pose&apos;s mean force, N [estimated from the poses].</source>
        <translation>Standardabweichung der mittleren Kraft einer Pose, N [aus den Posen geschätzt].</translation>
    </message>
    <message>
        <source>Standard deviation of a sample, N [measured in the touches].</source>
        <translation>Standardabweichung eines Messwerts, N [an den Berührungen gemessen].</translation>
    </message>
    <message>
        <source>Standard deviation of a torque.</source>
        <translation>Standardabweichung eines Moments.</translation>
    </message>
    <message>
        <source>Standard deviation of one reading.</source>
        <translation>Standardabweichung eines Messwerts.</translation>
    </message>
    <message>
        <source>Standard deviation of the Gaussian, mm [the contacts&apos; own uncertainty, at least 1.5].</source>
        <translation>Standardabweichung der Gaußfunktion, mm [die Unsicherheit der Kontakte selbst, mindestens 1,5].</translation>
    </message>
    <message>
        <source>Standard uncertainty of the mass, kg; half of a certificate&apos;s U (k = 2).</source>
        <translation>Standardunsicherheit der Masse, kg; die Hälfte des U eines Zertifikats (k = 2).</translation>
    </message>
    <message>
        <source>Still, after settling late: {0} s averaged so far.</source>
        <translation>Ruhig, nach spätem Beruhigen: bisher {0} s gemittelt.</translation>
    </message>
    <message>
        <source>Still: {0} s of {1} s averaged.{2}</source>
        <translation>Ruhig: {0} s von {1} s gemittelt.{2}</translation>
    </message>
    <message>
        <source>StillnessDetector.rate_hz must be positive and finite, not {0}</source>
        <translation>StillnessDetector.rate_hz muss positiv und endlich sein, nicht {0}</translation>
    </message>
    <message>
        <source>StillnessSettings.min_duration, {0} s, is above max_duration, {1} s: lower the first or raise the second</source>
        <translation>StillnessSettings.min_duration, {0} s, liegt über max_duration, {1} s: Senken Sie das eine oder erhöhen Sie das andere</translation>
    </message>
    <message>
        <source>StillnessSettings.window: {0} s; give {1} s or more</source>
        <translation>StillnessSettings.window: {0} s; geben Sie {1} s oder mehr an</translation>
    </message>
    <message>
        <source>StillnessSettings.{0} must be positive and finite, not {1}</source>
        <translation>StillnessSettings.{0} muss positiv und endlich sein, nicht {1}</translation>
    </message>
    <message>
        <source>Subtract what the sensor reads between touches, here and in the runtime; lift the probe clear for half a second before each touch.</source>
        <translation>Abziehen, was der Sensor zwischen den Berührungen anzeigt, hier und zur Laufzeit; die Sonde vor jeder Berührung eine halbe Sekunde frei anheben.</translation>
    </message>
    <message>
        <source>Supports of the 3MF file were left out (objects: {0}).</source>
        <translation>Stützen der 3MF-Datei wurden ausgelassen (Objekte: {0}).</translation>
    </message>
    <message>
        <source>Swap the two orientations, or retake the two poses.</source>
        <translation>Vertauschen Sie die beiden Orientierungen, oder nehmen Sie die beiden Posen noch einmal auf.</translation>
    </message>
    <message>
        <source>Swap {0} in the column names or in the driver.</source>
        <translation>In den Spaltennamen oder im Treiber vertauschen: {0}.</translation>
    </message>
    <message>
        <source>T_BP: give a pose of (4, 4), not {0}.</source>
        <translation>T_BP: Geben Sie eine Pose mit (4, 4) an, nicht {0}.</translation>
    </message>
    <message>
        <source>Take more poses tilted about two axes, or average each for longer.</source>
        <translation>Nehmen Sie mehr Posen mit Neigungen um zwei Achsen auf, oder mitteln Sie jede länger.</translation>
    </message>
    <message>
        <source>Take more poses, tilted about two axes by up to 90°.</source>
        <translation>Nehmen Sie mehr Posen auf, um zwei Achsen bis zu 90° geneigt.</translation>
    </message>
    <message>
        <source>Take {0} facets, the fewest measured that suffice: {1}.</source>
        <translation>Nehmen Sie {0} Facetten, die wenigsten gemessenen, die genügen: {1}.</translation>
    </message>
    <message>
        <source>Testing the devices.</source>
        <translation>Die Geräte werden getestet.</translation>
    </message>
    <message>
        <source>Text after the last facet of the OFF file, from line {0}, was left out.</source>
        <translation>Text nach der letzten Facette der OFF-Datei, ab Zeile {0}, wurde ausgelassen.</translation>
    </message>
    <message>
        <source>Text or JSON lines</source>
        <translation>Text- oder JSON-Zeilen</translation>
    </message>
    <message>
        <source>That took {0} attempts; the history lists them.</source>
        <translation>Das brauchte {0} Versuche; der Verlauf führt sie auf.</translation>
    </message>
    <message>
        <source>The PLY face property &apos;{0}&apos; was not written by contactbench and was ignored.</source>
        <translation>Die PLY-Facetteneigenschaft &apos;{0}&apos; stammt nicht von contactbench und wurde nicht beachtet.</translation>
    </message>
    <message>
        <source>The STL header announces no facets, but the file has room for {0}; these were read.</source>
        <translation>Der STL-Kopf kündigt keine Facetten an; die Datei hat Platz für {0}, und diese wurden gelesen.</translation>
    </message>
    <message>
        <source>The STL header announces {0} facets, but {1} more complete facets follow and were also read. Check that no part is missing.</source>
        <translation>Der STL-Kopf kündigt {0} Facetten an; es folgen {1} weitere vollständige Facetten, die ebenfalls gelesen wurden. Prüfen Sie, ob das Teil vollständig ist.</translation>
    </message>
    <message>
        <source>The STL text ends before &apos;endsolid&apos;. All its facets are complete, but if the file was cut short, some are missing.</source>
        <translation>Der STL-Text endet vor &apos;endsolid&apos;. Alle seine Facetten sind vollständig, aber wenn er abgeschnitten wurde, fehlen welche.</translation>
    </message>
    <message>
        <source>The angles are in {0}, but were read as {1}</source>
        <translation>Die Winkel sind in {0}, wurden aber als {1} gelesen</translation>
    </message>
    <message>
        <source>The angles cannot be {0}: {1}</source>
        <translation>Die Winkel können nicht in {0} sein: {1}</translation>
    </message>
    <message>
        <source>The angles look like radians. If they are, convert them to degrees.</source>
        <translation>Die Winkel sehen nach Radiant aus. Wenn sie es sind, rechnen Sie sie in Grad um.</translation>
    </message>
    <message>
        <source>The bag contains no poses of the flange.{0}</source>
        <translation>Das Bag enthält keine Posen des Flansches.{0}</translation>
    </message>
    <message>
        <source>The bias drifts by {0} from the first pose to the last{1}. The drift has been removed, and the bias is that at the end of the session. Let the sensor warm up, and recalibrate before you rely on it.</source>
        <translation>Der Nullpunktfehler driftet um {0} von der ersten Pose bis zur letzten{1}. Die Drift wurde herausgerechnet, und der Nullpunktfehler gilt für das Ende der Messreihe. Lassen Sie den Sensor warmlaufen, und kalibrieren Sie neu, bevor Sie sich darauf verlassen.</translation>
    </message>
    <message>
        <source>The calibration adds up to {0} mm (1 sigma) to a contact point</source>
        <translation>Die Kalibrierung trägt bis zu {0} mm (1 Sigma) zum Fehler eines Kontaktpunkts bei</translation>
    </message>
    <message>
        <source>The calibration is refused: calibrate again before you tell a robot its payload.</source>
        <translation>Die Kalibrierung ist abgelehnt: Kalibrieren Sie neu, bevor Sie einem Roboter seine Nutzlast angeben.</translation>
    </message>
    <message>
        <source>The calibration was refused, so a verification with it would not count. Recalibrate.</source>
        <translation>Die Kalibrierung wurde abgelehnt, eine Überprüfung damit würde nicht zählen. Kalibrieren Sie neu.</translation>
    </message>
    <message>
        <source>The calibration was refused, so do not trust these wrenches. {0}</source>
        <translation>Die Kalibrierung wurde abgelehnt: Vertrauen Sie diesen Kräften und Momenten nicht. {0}</translation>
    </message>
    <message>
        <source>The calibration was refused. {0} Recalibrate.</source>
        <translation>Die Kalibrierung wurde abgelehnt. {0} Kalibrieren Sie neu.</translation>
    </message>
    <message>
        <source>The calibration was refused: </source>
        <translation>Die Kalibrierung wurde abgelehnt: </translation>
    </message>
    <message>
        <source>The calibration was refused: recalibrate gravity first.</source>
        <translation>Die Kalibrierung wurde abgelehnt: Kalibrieren Sie zuerst die Schwerkraft neu.</translation>
    </message>
    <message>
        <source>The calibration was refused: recalibrate.</source>
        <translation>Die Kalibrierung wurde abgelehnt: Kalibrieren Sie neu.</translation>
    </message>
    <message>
        <source>The calibration was refused: {0}</source>
        <translation>Die Kalibrierung wird abgelehnt: {0}</translation>
    </message>
    <message>
        <source>The calibration&apos;s share of the contact error: {0} -&gt; {1} mm (1 sigma, worst case).</source>
        <translation>Anteil der Kalibrierung am Kontaktfehler: {0} -&gt; {1} mm (1 Sigma, schlechtester Fall).</translation>
    </message>
    <message>
        <source>The centre of mass lies {0} mm from the sensor, where no tool is: check the units of forces and torques ({1}), and the place of the tip (--tip).</source>
        <translation>Der Schwerpunkt liegt {0} mm vom Sensor entfernt, wo kein Werkzeug ist: Prüfen Sie die Einheiten von Kräften und Drehmomenten ({1}) und die Lage der Spitze (--tip).</translation>
    </message>
    <message>
        <source>The centre of mass lies {0} mm on the side of the sensor that is away from the tip: check the signs of the torques, and the place of the tip (--tip).</source>
        <translation>Der Schwerpunkt liegt {0} mm auf der von der Spitze abgewandten Seite des Sensors: die Vorzeichen der Drehmomente und die Lage der Spitze (--tip) prüfen.</translation>
    </message>
    <message>
        <source>The certificate&apos;s date {0} is not a date: write it as 2027-03-31, or leave it empty.</source>
        <translation>Das Datum des Kalibrierscheins, {0}, ist kein Datum: Schreiben Sie es wie 2027-03-31, oder lassen Sie es leer.</translation>
    </message>
    <message>
        <source>The channel {0} hardly responds ({1} % of its weight): it is dead</source>
        <translation>Der Kanal {0} reagiert kaum ({1} % seines Gewichtsanteils): Er ist tot</translation>
    </message>
    <message>
        <source>The channel {0} has the wrong sign</source>
        <translation>Der Kanal {0} hat das falsche Vorzeichen</translation>
    </message>
    <message>
        <source>The channel {0} reads {1} % of the weight beside its own: crosstalk</source>
        <translation>Der Kanal {0} zeigt {1} % des Gewichts aus anderen Kanälen an: Übersprechen</translation>
    </message>
    <message>
        <source>The channel {0} stands at its limit in several poses</source>
        <translation>Der Kanal {0} steht in mehreren Posen an seiner Grenze</translation>
    </message>
    <message>
        <source>The check failed.</source>
        <translation>Die Prüfung ist nicht bestanden.</translation>
    </message>
    <message>
        <source>The check failed. {0}</source>
        <translation>Die Prüfung ist nicht bestanden. {0}</translation>
    </message>
    <message>
        <source>The check is inconclusive.</source>
        <translation>Die Prüfung hat kein eindeutiges Ergebnis.</translation>
    </message>
    <message>
        <source>The check was inconclusive about sign, unit and scale of the sensor: use a heavier weight, or press the known point again.</source>
        <translation>Die Prüfung von Vorzeichen, Einheit und Skala des Sensors blieb ohne Ergebnis: ein schwereres Gewicht verwenden oder den bekannten Punkt noch einmal drücken.</translation>
    </message>
    <message>
        <source>The clock goes back: {0} samples that are not later than an earlier one are left out.</source>
        <translation>Die Uhr geht zurück: {0} Messwerte, die nicht später sind als einer davor, werden ausgelassen.</translation>
    </message>
    <message>
        <source>The config accepts touches that the verification did not, by these gates (as verified): {0}: export with the verified gates.</source>
        <translation>Die Konfiguration nimmt Berührungen an, die die Überprüfung nicht angenommen hätte, nach diesen Grenzen (geprüft): {0}: mit den geprüften Grenzen exportieren.</translation>
    </message>
    <message>
        <source>The config allows a touch {0} mm of torsion over force, the verification {1} mm, so more contacts are sure than were verified: verify with the same scene.</source>
        <translation>Die Konfiguration erlaubt einer Berührung {0} mm Torsion je Kraft, die Überprüfung {1} mm, deshalb gelten mehr Kontakte als sicher als geprüft: mit derselben Szene prüfen.</translation>
    </message>
    <message>
        <source>The contact moves as that of a ball that leans: press along the surface&apos;s normal, or with a sharper tip.</source>
        <translation>Der Kontakt wandert wie bei einer Kugel, die schräg aufsetzt: senkrecht zur Oberfläche drücken oder eine schärfere Spitze verwenden.</translation>
    </message>
    <message>
        <source>The controller already subtracts a payload that is heavier than the tool</source>
        <translation>Die Steuerung zieht bereits eine Nutzlast ab, die schwerer als das Werkzeug ist</translation>
    </message>
    <message>
        <source>The controller does not report the tool set on the pendant, so the orientation is that of the tool frame. Add ?tool=x,y,z,rx,ry,rz (m, rad) to the address, as set on the pendant.</source>
        <translation>Die Steuerung meldet das am Bediengerät eingestellte Werkzeug nicht, deshalb ist die Orientierung die des Werkzeugkoordinatensystems. Hängen Sie ?tool=x,y,z,rx,ry,rz (m, rad) wie am Bediengerät eingestellt an die Adresse an.</translation>
    </message>
    <message>
        <source>The damaged record at byte {0} is restored; its hash proves it.</source>
        <translation>Der beschädigte Eintrag bei Byte {0} ist wiederhergestellt; sein Hashwert belegt es.</translation>
    </message>
    <message>
        <source>The data are as declared</source>
        <translation>Die Daten sind wie angegeben</translation>
    </message>
    <message>
        <source>The data are consistent as they are: residuals {0}, gravity {1}° from down, mass {2} kg.</source>
        <translation>Die Daten sind stimmig, wie sie sind: Restabweichungen {0}, Schwerkraft {1}° von senkrecht nach unten, Masse {2} kg.</translation>
    </message>
    <message>
        <source>The data at byte {0} are damaged and were left out ({1}).</source>
        <translation>Die Daten bei Byte {0} sind beschädigt und wurden ausgelassen ({1}).</translation>
    </message>
    <message>
        <source>The data at byte {0} are too long ({1} bytes) and were left out.</source>
        <translation>Die Daten bei Byte {0} sind zu lang ({1} Byte) und wurden ausgelassen.</translation>
    </message>
    <message>
        <source>The description in the file is damaged ({0}).</source>
        <translation>Die Beschreibung in der Datei ist beschädigt ({0}).</translation>
    </message>
    <message>
        <source>The device did not accept AT+DCKMD=SUM: its frames end with a CRC-32, which is checked instead.</source>
        <translation>Das Gerät hat AT+DCKMD=SUM nicht angenommen: Seine Rahmen enden mit einer CRC-32; sie wird stattdessen geprüft.</translation>
    </message>
    <message>
        <source>The device did not accept {0} (it {1}): its rate or units may differ. Check that its firmware is supported.</source>
        <translation>Das Gerät hat {0} nicht angenommen ({1}): Seine Rate oder Einheiten können abweichen. Prüfen, ob seine Firmware unterstützt wird.</translation>
    </message>
    <message>
        <source>The device&apos;s clock or counter jumped ahead by {0} s while samples kept coming: its clock was set, or its counter is wrong. The times of the next 0.2 s are estimates and are marked.</source>
        <translation>Uhr oder Zähler des Geräts sprangen um {0} s vor, während weiter Messwerte kamen: Seine Uhr wurde gestellt, oder sein Zähler ist falsch. Die Zeiten der nächsten 0,2 s sind geschätzt und entsprechend gekennzeichnet.</translation>
    </message>
    <message>
        <source>The device&apos;s counter or clock restarted: it was switched off and on, or its clock was set. The times of the next 0.2 s are estimates and are marked.</source>
        <translation>Zähler oder Uhr des Geräts begannen von vorn: Es wurde aus- und eingeschaltet, oder seine Uhr wurde gestellt. Die Zeiten der nächsten 0,2 s sind geschätzt und entsprechend gekennzeichnet.</translation>
    </message>
    <message>
        <source>The devices were closed: the recording ends there.</source>
        <translation>Die Geräte wurden geschlossen: Die Aufzeichnung endet dort.</translation>
    </message>
    <message>
        <source>The disk is too slow, so samples are dropped. Record to another disk.</source>
        <translation>Der Datenträger ist zu langsam: Messwerte gehen verloren. Zeichnen Sie auf einem anderen auf.</translation>
    </message>
    <message>
        <source>The disk is too slow, so samples are missing in the recording. Record to another disk.</source>
        <translation>Der Datenträger ist zu langsam: In der Aufzeichnung fehlen Messwerte. Zeichnen Sie auf einen anderen auf.</translation>
    </message>
    <message>
        <source>The earlier regions are not shown: {0}</source>
        <translation>Die früheren Regionen werden nicht gezeigt: {0}</translation>
    </message>
    <message>
        <source>The end farther from the mesh&apos;s origin was taken as the tip; many files have their origin at the lens.</source>
        <translation>Als Spitze gilt das Ende, das weiter vom Ursprung des Netzes entfernt ist; viele Dateien haben ihren Ursprung an der Linse.</translation>
    </message>
    <message>
        <source>The error is the same at each touch of a marker but differs between markers: check the positions of {0}{1}.</source>
        <translation>Der Fehler ist bei jeder Berührung eines Markers gleich, aber von Marker zu Marker verschieden: Zu prüfen ist die Lage von: {0}{1}.</translation>
    </message>
    <message>
        <source>The errors are within the limits; {0} of the remaining error comes from {1}</source>
        <translation>Die Fehler sind innerhalb der Grenzen; vom verbleibenden Fehler kommt {0} aus: {1}</translation>
    </message>
    <message>
        <source>The face has only {0} mm², so a turn hardly shows. Check that the right facet was picked.</source>
        <translation>Die Fläche hat nur {0} mm², eine Drehung zeigt sich kaum. Prüfen Sie, ob die richtige Facette gewählt wurde.</translation>
    </message>
    <message>
        <source>The face is {0} mm off a plane: a curved or noisy face is a poor datum. Pick another facet, or lower the angle.</source>
        <translation>Die Fläche weicht {0} mm von einer Ebene ab: Eine gekrümmte oder verrauschte Fläche ist ein schlechter Bezug. Wählen Sie eine andere Facette, oder verkleinern Sie den Winkel.</translation>
    </message>
    <message>
        <source>The facets are too entangled to check every pair. {0}</source>
        <translation>Die Facetten sind zu sehr verschlungen, um jedes Paar zu prüfen. {0}</translation>
    </message>
    <message>
        <source>The file declares {0}</source>
        <translation>Die Datei gibt {0} an</translation>
    </message>
    <message>
        <source>The file is cut off after its last sample: only the table of contents is missing.</source>
        <translation>Die Datei ist nach ihrem letzten Messwert abgeschnitten: Nur das Inhaltsverzeichnis fehlt.</translation>
    </message>
    <message>
        <source>The file is cut off or damaged at byte {0} of {1}: everything up to there was read.</source>
        <translation>Die Datei ist bei Byte {0} von {1} abgeschnitten oder beschädigt: Alles davor wurde gelesen.</translation>
    </message>
    <message>
        <source>The file states that its numbers are {0}.</source>
        <translation>Die Datei gibt an, in welcher Einheit ihre Zahlen sind: {0}.</translation>
    </message>
    <message>
        <source>The file states {0}, but you asked for {1}, which are used.</source>
        <translation>Die Datei nennt {0}, verlangt haben Sie {1}; diese gelten.</translation>
    </message>
    <message>
        <source>The file was changed after it was written: its checksum does not match.</source>
        <translation>Die Datei wurde nach dem Schreiben verändert: Ihre Prüfsumme stimmt nicht.</translation>
    </message>
    <message>
        <source>The file&apos;s name ends in {0}, but it holds {1}.</source>
        <translation>Der Dateiname endet auf {0}, die Datei enthält aber {1}.</translation>
    </message>
    <message>
        <source>The file&apos;s numbers have decimal commas, which were read as decimal points.</source>
        <translation>Die Zahlen der Datei haben Dezimalkommas; sie wurden als Dezimalpunkte gelesen.</translation>
    </message>
    <message>
        <source>The file&apos;s {0} axis points up: coordinates are used as they are, as RViz does.</source>
        <translation>Die {0}-Achse der Datei zeigt nach oben: Koordinaten werden unverändert verwendet, wie in RViz.</translation>
    </message>
    <message>
        <source>The first line contains numbers: put the header {0} above it.</source>
        <translation>Die erste Zeile enthält Zahlen: Setzen Sie die Kopfzeile {0} darüber.</translation>
    </message>
    <message>
        <source>The first record is lost, so the session gets a new identity.</source>
        <translation>Der erste Eintrag ist verloren, deshalb bekommt die Sitzung eine neue Kennung.</translation>
    </message>
    <message>
        <source>The fitted mount is better on held-out touches (p = {0}).</source>
        <translation>Die angepasste Montage ist besser bei Berührungen, die neu für sie sind (p = {0}).</translation>
    </message>
    <message>
        <source>The fitted mount {0} on held-out touches.</source>
        <translation>Die angepasste Montage {0} bei Berührungen, die neu für sie sind.</translation>
    </message>
    <message>
        <source>The flange hardly turned, so no delay can be seen: turn it by 30° and back while recording.</source>
        <translation>Der Flansch drehte sich kaum, was keinen Verzug zeigt: Drehen Sie ihn während der Aufzeichnung um 30° und zurück.</translation>
    </message>
    <message>
        <source>The force changes in a direction {0}° away from straight down. {1}</source>
        <translation>Die Kraft ändert sich in einer Richtung {0}° neben der Lotrechten. {1}</translation>
    </message>
    <message>
        <source>The forces are in kgf (kilograms), not N: multiply them by 9.80665.</source>
        <translation>Die Kräfte sind in kgf (Kilogramm), nicht in N: mit 9.80665 multiplizieren.</translation>
    </message>
    <message>
        <source>The forces are in lbf (pounds), not N: multiply them by 4.448.</source>
        <translation>Die Kräfte sind in lbf (Pfund), nicht in N: mit 4.448 multiplizieren.</translation>
    </message>
    <message>
        <source>The forces are in mN, or the mass was given in tonnes: give it in kg.</source>
        <translation>Die Kräfte sind in mN, oder die Masse wurde in Tonnen angegeben: in kg angeben.</translation>
    </message>
    <message>
        <source>The forces have the wrong sign, or the world&apos;s z axis points down: give the direction of down.</source>
        <translation>Die Kräfte haben das falsche Vorzeichen, oder die z-Achse der Welt zeigt nach unten: angeben, wo unten ist.</translation>
    </message>
    <message>
        <source>The forces were multiplied by 4.448 once too often: they are treated as lbf, but are in N.</source>
        <translation>Die Kräfte wurden einmal zu oft mit 4.448 multipliziert: Sie werden für lbf gehalten, sind aber in N.</translation>
    </message>
    <message>
        <source>The forces were multiplied by 9.81 once too often: they are treated as kgf, but are in N.</source>
        <translation>Die Kräfte wurden einmal zu oft mit 9.81 multipliziert: Sie werden für kgf gehalten, sind aber in N.</translation>
    </message>
    <message>
        <source>The format is defined in {0}</source>
        <translation>Das Format ist in {0} festgelegt</translation>
    </message>
    <message>
        <source>The gain of the channel {0} is wrong by {1} %</source>
        <translation>Die Verstärkung des Kanals {0} ist um {1} % falsch</translation>
    </message>
    <message>
        <source>The inertia of a moving tool is not subtracted because {0}: 1 kg at 1 m/s² adds 1 N.</source>
        <translation>Die Trägheit eines bewegten Werkzeugs wird nicht abgezogen, weil {0}: 1 kg bei 1 m/s² sind 1 N.</translation>
    </message>
    <message>
        <source>The journal is intact: nothing to repair.</source>
        <translation>Das Journal ist unversehrt: Es gibt nichts zu reparieren.</translation>
    </message>
    <message>
        <source>The known touch {0}: find the wrong sign, unit or mounting, calibrate again, and check it again.</source>
        <translation>Der bekannte Druckpunkt {0}: das falsche Vorzeichen, die falsche Einheit oder Montage finden, neu kalibrieren und noch einmal prüfen.</translation>
    </message>
    <message>
        <source>The known weight of {0} kg was measured as {1} kg: find the wrong sign, unit or scale, calibrate again, and check it again.</source>
        <translation>Das bekannte Gewicht von {0} kg wurde mit {1} kg gemessen: das falsche Vorzeichen, die falsche Einheit oder Skala finden, neu kalibrieren und noch einmal prüfen.</translation>
    </message>
    <message>
        <source>The last write failed, so nothing is written to this session at the moment. Free disk space, or check the disk; writing then resumes automatically.</source>
        <translation>Das letzte Schreiben ist fehlgeschlagen, deshalb wird zurzeit nichts in diese Sitzung geschrieben. Schaffen Sie Platz, oder prüfen Sie den Datenträger; dann geht es von selbst weiter.</translation>
    </message>
    <message>
        <source>The latest results are exported.</source>
        <translation>Die neuesten Ergebnisse sind exportiert.</translation>
    </message>
    <message>
        <source>The line of force passes only {0} mm from the sensor&apos;s origin, so a wrong sign or unit of the torques would not show.</source>
        <translation>Die Kraftlinie verläuft nur {0} mm neben dem Ursprung des Sensors, deshalb wäre ein falsches Vorzeichen oder eine falsche Einheit der Drehmomente nicht zu sehen.</translation>
    </message>
    <message>
        <source>The line of force passes through the point, but no contact was found there. Check the mesh at this point, and that nothing else touched the probe.</source>
        <translation>Die Kraftlinie geht durch den Punkt, dort wurde aber kein Kontakt gefunden. Das Netz an diesem Punkt prüfen, und ob sonst nichts die Sonde berührt hat.</translation>
    </message>
    <message>
        <source>The markers are still being saved: wait a moment, then start again.</source>
        <translation>Die Marker werden noch gespeichert: Warten Sie einen Moment, und beginnen Sie dann neu.</translation>
    </message>
    <message>
        <source>The mass was given in grams instead of kg, or the forces are in kN.</source>
        <translation>Die Masse wurde in Gramm statt in kg angegeben, oder die Kräfte sind in kN.</translation>
    </message>
    <message>
        <source>The mass was probably given in pounds: give it in kg.</source>
        <translation>Die Masse wurde vermutlich in Pfund angegeben: in kg angeben.</translation>
    </message>
    <message>
        <source>The mesh</source>
        <translation>Das Netz</translation>
    </message>
    <message>
        <source>The mesh has {0} separate parts ({1}{2})</source>
        <translation>Das Netz hat {0} getrennte Teile ({1}{2})</translation>
    </message>
    <message>
        <source>The mesh has {0} separate parts. A part inside the housing can be mistaken for the surface. Keep only the outer shell.</source>
        <translation>Das Netz hat {0} getrennte Teile. Ein Teil im Gehäuse kann für die Oberfläche gehalten werden. Behalten Sie nur die Außenhülle.</translation>
    </message>
    <message>
        <source>The mesh is an open sheet: {0} of the area can be seen from both sides, so it has no inside. Export the whole part as a solid.</source>
        <translation>Das Netz ist ein offenes Blatt: {0} der Fläche sind von beiden Seiten zu sehen, es hat also kein Inneres. Exportieren Sie das ganze Teil als Volumenkörper.</translation>
    </message>
    <message>
        <source>The mesh is in its own frame: align it with the sensor before use.</source>
        <translation>Das Netz ist in seinem eigenen System: Richten Sie es am Sensor aus, bevor es benutzt wird.</translation>
    </message>
    <message>
        <source>The mesh is inside out: its facets face inwards, so contacts would be found on the far side of the probe. Flip all normals in the CAD program, or make the outer shell, which flips them.</source>
        <translation>Das Netz ist umgestülpt: Seine Facetten zeigen nach innen, deshalb würden Kontakte auf der Gegenseite der Sonde gefunden. Drehen Sie im CAD-Programm alle Normalen um, oder machen Sie die Außenfläche; dabei geschieht es von selbst.</translation>
    </message>
    <message>
        <source>The mesh is inside out: its facets face inwards, so contacts would be found on the far side of the probe. Flip all normals in the CAD program.</source>
        <translation>Das Netz ist umgestülpt: Seine Facetten zeigen nach innen, deshalb würden Kontakte auf der Gegenseite der Sonde gefunden. Drehen Sie im CAD-Programm alle Normalen um.</translation>
    </message>
    <message>
        <source>The mesh is open or badly wound and has no volume, so its area was used instead.</source>
        <translation>Das Netz ist offen oder falsch orientiert und hat kein Volumen: Stattdessen wurde seine Fläche gewichtet.</translation>
    </message>
    <message>
        <source>The mesh&apos;s edges there are {0} mm long, longer than the bandwidth of {1} mm, so the map is no finer than the mesh. Use a mesh with more facets.</source>
        <translation>Die Kanten des Netzes sind dort {0} mm lang, länger als die Bandbreite von {1} mm: Die Karte ist nicht feiner als das Netz. Nehmen Sie ein Netz mit mehr Facetten.</translation>
    </message>
    <message>
        <source>The mesh&apos;s origin lies in its middle, so it cannot tell the tip from the handle.</source>
        <translation>Der Ursprung des Netzes liegt in seiner Mitte und unterscheidet die Spitze nicht vom Griff.</translation>
    </message>
    <message>
        <source>The mesh&apos;s origin point was placed on its position, its axis point on +z, its plane point towards +x.</source>
        <translation>Der Ursprungspunkt des Netzes auf seine Stelle gelegt, sein Achsenpunkt auf +z, sein Ebenenpunkt zu +x hin.</translation>
    </message>
    <message>
        <source>The mesh&apos;s own facets could not be used: cut where they cross, they gave no valid surface.</source>
        <translation>Die eigenen Facetten des Netzes waren nicht verwendbar: Zerteilt, wo sie sich durchschneiden, ergaben sie keine brauchbare Oberfläche.</translation>
    </message>
    <message>
        <source>The mesh&apos;s own facets could not be used: the patches do not meet the rims of the openings everywhere.</source>
        <translation>Die eigenen Facetten des Netzes waren nicht verwendbar: Die Flicken treffen nicht überall auf die Ränder der Öffnungen.</translation>
    </message>
    <message>
        <source>The mesh&apos;s own facets enclose no space, even with the holes closed: too many are loose, torn or without thickness.</source>
        <translation>Die eigenen Facetten des Netzes umschließen keinen Raum, auch nicht mit geschlossenen Löchern: Zu viele sind lose, zerrissen oder ohne Dicke.</translation>
    </message>
    <message>
        <source>The model error was not measured; {0} are assumed. Touch at least {1} markers to measure it.</source>
        <translation>Der Modellfehler wurde nicht gemessen; {0} werden angenommen. Zum Messen mindestens {1} Marker berühren.</translation>
    </message>
    <message>
        <source>The mount&apos;s rotation about {0} cannot be distinguished from a tilt of the base: {1}. {2}.</source>
        <translation>Die Drehung der Montage um {0} ist von einer Neigung der Basis nicht zu unterscheiden: {1}. {2}.</translation>
    </message>
    <message>
        <source>The mount&apos;s rotation about {0} is known only to {1}° (1 sigma)</source>
        <translation>Die Drehung der Montage um {0} ist nur auf {1}° (1 Sigma) bekannt</translation>
    </message>
    <message>
        <source>The mounting face ({0} facets, {1} mm², plane to {2} mm rms, {3} at most) laid on z = {4} mm; {5}, on the axis.</source>
        <translation>Die Montagefläche ({0} Facetten, {1} mm², eben auf {2} mm rms, höchstens {3}) auf z = {4} mm gelegt; {5}, auf der Achse.</translation>
    </message>
    <message>
        <source>The noise was not given, so units can only be judged by the resulting mass and centre of mass. Give the noise from the sensor&apos;s data sheet{0}.</source>
        <translation>Das Rauschen wurde nicht angegeben, deshalb lassen sich Einheiten nur an der Masse und dem Schwerpunkt erkennen, die sich damit ergeben. Geben Sie das Rauschen aus dem Datenblatt des Sensors an{0}.</translation>
    </message>
    <message>
        <source>The numbers span {0}: the longest side is {1}{2}. Measure the probe and give --units {3}.</source>
        <translation>Die Zahlen umfassen {0}: Die längste Seite ist {1}{2}. Messen Sie die Sonde, und geben Sie --units {3} an.</translation>
    </message>
    <message>
        <source>The numbers span {0}: {1}{2}.</source>
        <translation>Die Zahlen umfassen {0}: {1}{2}.</translation>
    </message>
    <message>
        <source>The orientations are transposed ({0}, not {1})</source>
        <translation>Die Orientierungen sind transponiert ({0}, nicht {1})</translation>
    </message>
    <message>
        <source>The orientations are {0}, not {1}</source>
        <translation>Die Orientierungen sind {0}, nicht {1}</translation>
    </message>
    <message>
        <source>The orientations of poses {0} and {1} are swapped</source>
        <translation>Die Orientierungen der Posen {0} und {1} sind vertauscht</translation>
    </message>
    <message>
        <source>The orientations or the mount are wrong, or something else pulled on the tool.</source>
        <translation>Die Orientierungen oder die Montage stimmen nicht, oder etwas anderes hat am Werkzeug gezogen.</translation>
    </message>
    <message>
        <source>The orientations scatter by {0}°, not by the specified {1}°. All uncertainties are computed from the scatter of the poses.</source>
        <translation>Die Orientierungen streuen um {0}°, nicht um die angegebenen {1}°. Alle Unsicherheiten sind aus der Streuung der Posen berechnet.</translation>
    </message>
    <message>
        <source>The orientations were made from {0} as if they were {1}</source>
        <translation>Die Orientierungen wurden falsch umgerechnet: als {1}, obwohl es {0} waren</translation>
    </message>
    <message>
        <source>The paper&apos;s control, or with motion feed-forward [the bundle&apos;s].</source>
        <translation>Die Regelung der Veröffentlichung, oder mit Vorsteuerung der Bewegung [die des Bündels].</translation>
    </message>
    <message>
        <source>The parameter {0}.{1} was set to {2} on {3}; this was computed with {4}.</source>
        <translation>Der Parameter {0}.{1} wurde am {3} auf {2} gesetzt; berechnet wurde es mit {4}.</translation>
    </message>
    <message>
        <source>The patch has no rim: it is a closed surface. Pick a facet of a plane face.</source>
        <translation>Das Flächenstück hat keinen Rand: Es ist eine geschlossene Fläche. Wählen Sie eine Facette einer ebenen Fläche.</translation>
    </message>
    <message>
        <source>The point is the centre of pressure of a patch of {0} cm²: {1} ± {2} mm along x and {3} ± {4} mm along y from its middle; it is pressed at a tilt of {5} ± {6}° along x and {7} ± {8}° along y; the force is {9} and {10}.</source>
        <translation>Der Punkt ist das Druckzentrum einer Fläche von {0} cm²: {1} ± {2} mm in x und {3} ± {4} mm in y von ihrer Mitte; gedrückt wird mit einer Neigung von {5} ± {6}° in x und {7} ± {8}° in y; die Kraft ist {9} und {10}.</translation>
    </message>
    <message>
        <source>The points are all in one place: pick points far apart.</source>
        <translation>Die Punkte liegen alle an einer Stelle: Wählen Sie Punkte, die weit voneinander entfernt sind.</translation>
    </message>
    <message>
        <source>The points are symmetric: in the order {0} they fit as well, with the mesh turned by {1}°, so a mix-up would not show. Add a point that breaks the symmetry.</source>
        <translation>Die Punkte liegen symmetrisch: In der Reihenfolge {0} passen sie ebenso gut, mit um {1}° gedrehtem Netz, sodass eine Verwechslung nicht auffiele. Fügen Sie einen Punkt hinzu, der die Symmetrie bricht.</translation>
    </message>
    <message>
        <source>The points disagree by up to {0} mm, more than an accuracy of {1} mm explains. The uncertainty has been widened accordingly.</source>
        <translation>Die Punkte widersprechen sich um bis zu {0} mm, mehr als eine Genauigkeit von {1} mm erklärt. Die Unsicherheit wurde entsprechend vergrößert.</translation>
    </message>
    <message>
        <source>The points fit better mirrored (within {0} mm rms, else {1} mm): check the signs of the axes and the order of the points.</source>
        <translation>Die Punkte passen gespiegelt besser (auf {0} mm RMS, sonst {1} mm): Vorzeichen der Achsen und Reihenfolge der Punkte prüfen.</translation>
    </message>
    <message>
        <source>The points lie nearly on one line ({0} mm off it, {1} mm along it, rms), so a turn about it is not determined: pick one well to the side.</source>
        <translation>Die Punkte liegen fast auf einer Geraden ({0} mm daneben, {1} mm entlang, rms), deshalb ist eine Drehung um sie nicht zu sehen: Wählen Sie einen weit seitlich davon.</translation>
    </message>
    <message>
        <source>The press is recorded.</source>
        <translation>Der Druck ist aufgenommen.</translation>
    </message>
    <message>
        <source>The press was located {0} ± {1} mm from the known point.</source>
        <translation>Der Druck wurde {0} ± {1} mm neben dem bekannten Punkt gefunden.</translation>
    </message>
    <message>
        <source>The press was located {0} ± {1} mm from the known point: signs and units are correct.</source>
        <translation>Der Druck wurde {0} ± {1} mm neben dem bekannten Punkt gefunden: Vorzeichen und Einheiten stimmen.</translation>
    </message>
    <message>
        <source>The probe changed after the regions were painted; they were transferred to it.</source>
        <translation>Die Sonde hat sich geändert, nachdem die Regionen gemalt wurden; sie wurden übertragen.</translation>
    </message>
    <message>
        <source>The probe has {0}.</source>
        <translation>Die Sonde hat {0}.</translation>
    </message>
    <message>
        <source>The probe is hollow: {0} of the outside is a wall, typically {1} thick, with a space behind it that can hardly be seen from outside. Contacts can be placed on the inner side of the wall, and facets are wasted on it.</source>
        <translation>Die Sonde ist hohl. Anteil der Außenseite, der eine Wand ist: {0}; Wanddicke meist {1}, mit einem Raum dahinter, der von außen kaum zu sehen ist. Kontakte können auf die Innenseite der Wand gelegt werden, und Facetten werden an sie verschwendet.</translation>
    </message>
    <message>
        <source>The probe is not aligned with the sensor (its frame is P): align it first.</source>
        <translation>Die Sonde ist nicht am Sensor ausgerichtet (ihr Koordinatensystem ist P): ausrichten.</translation>
    </message>
    <message>
        <source>The probe rotates against its sensor under load: tighten or stiffen its mount, then realign and verify again.</source>
        <translation>Die Sonde dreht sich unter Last gegen ihren Sensor: die Befestigung anziehen oder versteifen, dann neu ausrichten und verifizieren.</translation>
    </message>
    <message>
        <source>The quaternions are in the order {0}, but were read as {1}</source>
        <translation>Die Quaternionen sind in der Reihenfolge {0}, wurden aber als {1} gelesen</translation>
    </message>
    <message>
        <source>The reading jumped by {0} N and {1} N·m within one sample, to nearly zero in all six channels, and stayed there: the sensor may have been re-zeroed. If so, recalibrate.</source>
        <translation>Die Anzeige sprang innerhalb eines einzigen Messwerts um {0} N und {1} N·m, in allen sechs Kanälen auf fast null, und blieb dort: Vielleicht wurde der Sensor neu genullt. Wenn ja, kalibrieren Sie erneut.</translation>
    </message>
    <message>
        <source>The readings are raw, not calibrated by the sensor: set it to engineering units.</source>
        <translation>Die Messwerte sind roh, nicht vom Sensor kalibriert: ihn auf physikalische Einheiten stellen.</translation>
    </message>
    <message>
        <source>The readings differ between poses by {0} times what noise and calibration explain: something swung, touched the tool or slipped, or the force channels have different scales.</source>
        <translation>Die Messungen unterscheiden sich zwischen den Posen um das {0}-fache dessen, was Rauschen und Kalibrierung erklären: Etwas hat gependelt, das Werkzeug berührt oder ist verrutscht, oder die Kraftkanäle haben verschiedene Skalen.</translation>
    </message>
    <message>
        <source>The readings do not show the weight: it was not on the tool, it rested on something, or the readings with and without it are the same.</source>
        <translation>Das Gewicht ist in den Messungen nicht zu sehen: Es hing nicht am Werkzeug, lag auf etwas auf, oder die Messungen mit und ohne Gewicht sind dieselben.</translation>
    </message>
    <message>
        <source>The readings with and without the weight are probably swapped: the tool&apos;s own weight points down.</source>
        <translation>Die Messungen mit und ohne Gewicht sind vermutlich vertauscht: Das Eigengewicht des Werkzeugs zeigt nach unten.</translation>
    </message>
    <message>
        <source>The record after record {0} cannot be read and is left out.</source>
        <translation>Der Eintrag nach Eintrag {0} ist nicht lesbar und fehlt in der Kopie.</translation>
    </message>
    <message>
        <source>The record at byte {0} appears twice; one copy is kept.</source>
        <translation>Der Eintrag bei Byte {0} ist doppelt vorhanden; einer bleibt erhalten.</translation>
    </message>
    <message>
        <source>The record at byte {0} was never finished, so nothing relied on it.</source>
        <translation>Der Eintrag bei Byte {0} wurde nie fertig geschrieben, also hat sich nichts darauf verlassen.</translation>
    </message>
    <message>
        <source>The recording does not show its noise, so a typical sensor noise is assumed.</source>
        <translation>Die Aufzeichnung zeigt ihr Rauschen nicht, deshalb wird ein typisches Sensorrauschen angenommen.</translation>
    </message>
    <message>
        <source>The recording has more events than fit into memory: some were left out.</source>
        <translation>Es enthält mehr Ereignisse, als in den Speicher passen: Einige sind ausgelassen.</translation>
    </message>
    <message>
        <source>The recording has several flanges, so the table has no poses.</source>
        <translation>Es gibt mehrere Flansche: Die Tabelle hat keine Posen.</translation>
    </message>
    <message>
        <source>The recording has {0} gaps, the longest of {1} s: a touch ends where a gap begins.</source>
        <translation>Lücken in der Aufzeichnung: {0}, die längste {1} s: Wo eine beginnt, endet eine Berührung.</translation>
    </message>
    <message>
        <source>The recording {0} cannot be read and is kept unchanged: {1}</source>
        <translation>Die Aufzeichnung {0} kann nicht gelesen werden und bleibt unverändert: {1}</translation>
    </message>
    <message>
        <source>The recording {0} ended abruptly at {1}; recovered with</source>
        <translation>Die Aufzeichnung {0} endete plötzlich, Zeitpunkt: {1}; gerettet mit</translation>
    </message>
    <message>
        <source>The recording {0} ended abruptly before its first sample and was not kept.</source>
        <translation>Die Aufzeichnung {0} endete plötzlich vor ihrem ersten Messwert und wurde nicht behalten.</translation>
    </message>
    <message>
        <source>The recording {0} is already in the session: its duplicate name has been removed.</source>
        <translation>Die Aufzeichnung {0} ist schon in der Sitzung: Ihr zweiter Name wurde entfernt.</translation>
    </message>
    <message>
        <source>The recording {0} never started: its empty file has been removed.</source>
        <translation>Die Aufzeichnung {0} wurde nie begonnen: Ihre leere Datei wurde entfernt.</translation>
    </message>
    <message>
        <source>The recording {0} {1} and was not kept.</source>
        <translation>Die Aufzeichnung {0} {1} und wurde nicht behalten.</translation>
    </message>
    <message>
        <source>The reference reads {0} N where the sensor reads {1} N: check its unit (N), and that it was pressed during these touches.</source>
        <translation>Die Referenz zeigt {0} N, wo der Sensor {1} N zeigt: Prüfen Sie ihre Einheit (N), und ob bei diesen Berührungen auf sie gedrückt wurde.</translation>
    </message>
    <message>
        <source>The region is empty: paint something first.</source>
        <translation>Die Region ist leer: Malen Sie zuerst etwas.</translation>
    </message>
    <message>
        <source>The region ratio is {0}, but the mesh has no region: facets are spread evenly. Mark a region first (contactbench probe regions add).</source>
        <translation>Das Verhältnis für Regionen ist {0}, aber das Netz hat keine Region: Die Facetten sind gleichmäßig verteilt. Markieren Sie zuerst eine (contactbench probe regions add).</translation>
    </message>
    <message>
        <source>The regions are painted but not applied to the probe yet: apply them.</source>
        <translation>Die Regionen sind gemalt, aber noch nicht auf die Sonde angewendet: Wenden Sie sie an.</translation>
    </message>
    <message>
        <source>The regions have changed in the meantime, so nothing was done: repeat it.</source>
        <translation>Die Regionen haben sich inzwischen geändert, deshalb wurde nichts getan: Wiederholen Sie es.</translation>
    </message>
    <message>
        <source>The residuals are {0} times (forces) and {1} times (torques) what the specified noise explains. All uncertainties are computed from the scatter of the poses.</source>
        <translation>Die Restabweichungen sind das {0}-Fache (Kräfte) und das {1}-Fache (Momente) dessen, was das angegebene Rauschen erklärt. Alle Unsicherheiten sind aus der Streuung der Posen berechnet.</translation>
    </message>
    <message>
        <source>The residuals are {0} times what the calibration&apos;s uncertainty and noise explain (p = {1}), largest in {2} ({3} sigma): drift since the calibration, wrong orientations, or a touch.</source>
        <translation>Die Restabweichungen sind das {0}-Fache dessen, was Unsicherheit der Kalibrierung und Rauschen erklären (p = {1}), am meisten in {2} ({3} Sigma): Drift seit der Kalibrierung, falsche Orientierungen oder eine Berührung.</translation>
    </message>
    <message>
        <source>The rim is not round, so the axis goes through the middle of the area inside it; screw holes and notches in the rim shift that. Check it against the drawing.</source>
        <translation>Der Rand ist nicht rund: Die Achse geht durch die Mitte der Fläche innerhalb, die sich durch Schraubenlöcher und Kerben im Rand verschiebt. Vergleichen Sie sie mit der Zeichnung.</translation>
    </message>
    <message>
        <source>The rung of {0} facets is missing: {1}</source>
        <translation>Die Stufe mit {0} Facetten fehlt: {1}</translation>
    </message>
    <message>
        <source>The same for a torque, N·m.</source>
        <translation>Das Gleiche für ein Drehmoment, N·m.</translation>
    </message>
    <message>
        <source>The same for a torque.</source>
        <translation>Dasselbe für ein Moment.</translation>
    </message>
    <message>
        <source>The same for a torque; give both or neither.</source>
        <translation>Dasselbe für ein Moment; beide angeben oder keines.</translation>
    </message>
    <message>
        <source>The same for its torque, N·m; give both or neither.</source>
        <translation>Das Gleiche für ihr Drehmoment, N·m; beide oder keines.</translation>
    </message>
    <message>
        <source>The sample times went back, so the captures start over: {0}</source>
        <translation>Die Zeiten der Messwerte liefen zurück, deshalb beginnen die Aufnahmen neu: {0}</translation>
    </message>
    <message>
        <source>The sensor</source>
        <translation>Der Sensor</translation>
    </message>
    <message>
        <source>The sensor cannot keep its rate: choose a lower one.</source>
        <translation>Der Sensor kann seine Rate nicht halten: eine niedrigere wählen.</translation>
    </message>
    <message>
        <source>The sensor did not report its counts per newton ({0}) {1} per N and {2} per N·m are assumed: compare with its calibration sheet, and give cpf and cpt in the address.</source>
        <translation>Der Sensor hat seine Zählschritte pro Newton nicht angegeben ({0}). Angenommen werden {1} pro N und {2} pro N·m: mit seinem Kalibrierblatt vergleichen und cpf und cpt in der Adresse angeben.</translation>
    </message>
    <message>
        <source>The sensor does not identify itself; the bundle is for {0}: make sure it is this one.</source>
        <translation>Der Sensor gibt sich nicht zu erkennen; das Bundle ist für {0}: Stellen Sie sicher, dass es dieser ist.</translation>
    </message>
    <message>
        <source>The sensor does not respond yet: check its power and cable.</source>
        <translation>Der Sensor antwortet noch nicht: Prüfen Sie Stromversorgung und Kabel.</translation>
    </message>
    <message>
        <source>The sensor feels no weight, so no convention can be tested. Take the poses with the tool mounted, check the unit of the forces, and that the sensor does not re-zero itself.</source>
        <translation>Der Sensor spürt kein Gewicht, deshalb lässt sich keine Konvention prüfen. Nehmen Sie die Posen mit montiertem Werkzeug auf, prüfen Sie die Einheit der Kräfte und dass der Sensor sich nicht selbst neu nullt.</translation>
    </message>
    <message>
        <source>The sensor feels no weight, so no pose shows the centre of mass. If a tool is mounted, check the unit of the forces and that the sensor does not re-zero itself.</source>
        <translation>Der Sensor spürt kein Gewicht, deshalb zeigt keine Pose den Schwerpunkt. Falls ein Werkzeug montiert ist, prüfen Sie die Einheit der Kräfte und dass der Sensor sich nicht selbst neu nullt.</translation>
    </message>
    <message>
        <source>The sensor has gone silent. Check its cable and power; it resumes automatically.</source>
        <translation>Der Sensor ist verstummt. Prüfen Sie Kabel und Stromversorgung; es geht von selbst weiter.</translation>
    </message>
    <message>
        <source>The sensor is disconnected: plug it in again. It resumes automatically.</source>
        <translation>Der Sensor ist getrennt: Stecken Sie ihn wieder ein. Es geht von selbst weiter.</translation>
    </message>
    <message>
        <source>The sensor is heard {0}{1} ms {2} than the robot.</source>
        <translation>Der Sensor ist {0}{1} ms {2} zu hören als der Roboter.</translation>
    </message>
    <message>
        <source>The sensor is mounted on the flange {0}° differently than declared: with that corrected, the poses agree. {1} Set the mount accordingly, or check how the sensor is bolted on.</source>
        <translation>Der Sensor sitzt {0}° anders auf dem Flansch als angegeben: Berichtigt stimmen die Posen überein. {1} Stellen Sie die Montage entsprechend ein, oder prüfen Sie, wie der Sensor angeschraubt ist.</translation>
    </message>
    <message>
        <source>The sensor is turned by {0} about its axis ({1}) on the flange</source>
        <translation>Der Sensor ist auf dem Flansch um {0} um seine Achse ({1}) gedreht</translation>
    </message>
    <message>
        <source>The sensor is turned by {0} about its z axis on the flange</source>
        <translation>Der Sensor ist auf dem Flansch um {0} um seine z-Achse gedreht</translation>
    </message>
    <message>
        <source>The sensor is {0} K {1} than at the start, and its zero drifts with it: let it settle, then recalibrate.</source>
        <translation>Der Sensor ist {0} K {1} als am Anfang, und sein Nullpunkt wandert damit: zur Ruhe kommen lassen, dann erneut kalibrieren.</translation>
    </message>
    <message>
        <source>The sensor reads {0} N with nothing touching: recalibrate, or raise the forces at which a touch begins and ends (now {1} and {2} N).</source>
        <translation>Der Sensor zeigt {0} N, während nichts berührt wird: Kalibrieren Sie neu, oder erhöhen Sie die Kräfte, bei denen eine Berührung beginnt und endet (jetzt {1} und {2} N).</translation>
    </message>
    <message>
        <source>The sensor reads {0} N, but nothing should touch it yet: lift the probe clear. If nothing touches it, recalibrate.</source>
        <translation>Der Sensor zeigt {0} N, aber noch sollte ihn nichts berühren: Heben Sie die Sonde an. Wenn sie nichts berührt, kalibrieren Sie neu.</translation>
    </message>
    <message>
        <source>The sensor reads {0} times the weight, upwards. {1}</source>
        <translation>Der Sensor misst das {0}-fache des Gewichts, nach oben. {1}</translation>
    </message>
    <message>
        <source>The sensor reads {0} times the weight. {1} {2}</source>
        <translation>Der Sensor misst das {0}-fache des Gewichts. {1} {2}</translation>
    </message>
    <message>
        <source>The sensor reads {0} too much, or something touches the probe. If nothing does, {1}. Lift the probe clear and hold it still at three tilts, 20° apart.</source>
        <translation>Der Sensor misst {0} zu viel, oder etwas berührt die Sonde. Wenn nichts sie berührt, gilt: {1}. Heben Sie die Sonde frei an, und halten Sie sie in drei Neigungen still, je 20° auseinander.</translation>
    </message>
    <message>
        <source>The sensor reads {0} ± {1} % too little.</source>
        <translation>Der Sensor misst {0} ± {1} % zu wenig.</translation>
    </message>
    <message>
        <source>The sensor reads {0} ± {1} % too much.</source>
        <translation>Der Sensor misst {0} ± {1} % zu viel.</translation>
    </message>
    <message>
        <source>The sensor reads {0} ± {1} kg for a weight of {2} kg, {3}° from straight down: unit, sign and scale of the forces are correct.</source>
        <translation>Der Sensor misst {0} ± {1} kg für ein Gewicht von {2} kg, {3}° neben der Lotrechten: Einheit, Vorzeichen und Skala der Kräfte stimmen.</translation>
    </message>
    <message>
        <source>The sensor reports an error or overload: remove the load. If that does not help, check its own display or manual.</source>
        <translation>Der Sensor meldet einen Fehler oder eine Überlast: die Last entfernen. Hilft das nicht, seine eigene Anzeige oder Anleitung ansehen.</translation>
    </message>
    <message>
        <source>The sensor reports that its readings are invalid: switch it off and on.</source>
        <translation>Der Sensor meldet ungültige Messwerte: aus- und einschalten.</translation>
    </message>
    <message>
        <source>The sensor sends readings, but no orientation arrives with them, so nothing can be captured.</source>
        <translation>Der Sensor sendet Messwerte, aber ohne Orientierung, deshalb kann nichts aufgenommen werden.</translation>
    </message>
    <message>
        <source>The sensor sends {0} samples per second, but the bundle is for {1}, so its filters act at another frequency. Set the sensor&apos;s rate, or export for this one.</source>
        <translation>Der Sensor liefert {0} Messwerte pro Sekunde, das Paket ist für {1}: Seine Filter wirken bei einer anderen Frequenz. Stellen Sie die Rate des Sensors ein, oder exportieren Sie für diese.</translation>
    </message>
    <message>
        <source>The sensor was re-zeroed between poses {0} and {1}</source>
        <translation>Der Sensor wurde zwischen Pose {0} und Pose {1} neu genullt</translation>
    </message>
    <message>
        <source>The sensor {0} was re-zeroed on {1}{2}</source>
        <translation>Der Sensor {0} wurde am {1} neu auf null gesetzt{2}</translation>
    </message>
    <message>
        <source>The sensor&apos;s orientation is unknown: choose a source of poses in step 1, Devices.</source>
        <translation>Die Orientierung des Sensors ist unbekannt: Wählen Sie in Schritt 1, Geräte, eine Quelle der Posen.</translation>
    </message>
    <message>
        <source>The sensor&apos;s origin in the flange&apos;s frame, mm.</source>
        <translation>Ursprung des Sensors im Flanschsystem, mm.</translation>
    </message>
    <message>
        <source>The sensor&apos;s z axis points away from the tool</source>
        <translation>Die z-Achse des Sensors zeigt vom Werkzeug weg</translation>
    </message>
    <message>
        <source>The sensor&apos;s zero drifts</source>
        <translation>Der Nullpunkt des Sensors driftet</translation>
    </message>
    <message>
        <source>The sensor&apos;s zero drifts from touch to touch: let it warm up and recalibrate, or let the zero follow.</source>
        <translation>Der Nullpunkt des Sensors driftet von Berührung zu Berührung: warmlaufen lassen und neu kalibrieren, oder den Nullpunkt nachführen.</translation>
    </message>
    <message>
        <source>The sensor&apos;s zero is confirmed: off by {0}; {1}.</source>
        <translation>Der Nullpunkt des Sensors ist bestätigt: {0} daneben; {1}.</translation>
    </message>
    <message>
        <source>The sensor&apos;s zero is not known yet: hold the probe still for a second without touching anything.</source>
        <translation>Der Nullpunkt des Sensors ist noch nicht bekannt: Halten Sie die Sonde eine Sekunde lang still, ohne dass sie etwas berührt.</translation>
    </message>
    <message>
        <source>The sensor&apos;s zero is off by {0}: {1}. Recalibrate before you trust a contact.</source>
        <translation>Der Nullpunkt des Sensors liegt {0} daneben: {1}. Kalibrieren Sie neu, bevor Sie einem Kontakt trauen.</translation>
    </message>
    <message>
        <source>The sensor&apos;s zero jumped by {0} before {1}, as after a re-zero. The bias is that of the poses since then. Do not zero the sensor while taking poses.</source>
        <translation>Der Nullpunkt des Sensors sprang um {0} vor {1}, wie nach einem Nullen. Der Nullpunktfehler gilt für die Posen seither. Nullen Sie den Sensor nicht, während Sie Posen aufnehmen.</translation>
    </message>
    <message>
        <source>The sensor&apos;s {0} axis is reversed</source>
        <translation>Die {0}-Achse des Sensors ist umgekehrt</translation>
    </message>
    <message>
        <source>The sensor&apos;s {0} is {1}, but the bundle is for {2}: contacts from another sensor are wrong.</source>
        <translation>Angabe des Sensors ({0}): {1}; das Paket ist für {2}: Mit einem anderen Sensor sind seine Kontakte falsch.</translation>
    </message>
    <message>
        <source>The server sends no body {0}, only {1}: correct ?device= in the address, or bring the body in sight.</source>
        <translation>Der Server sendet keinen Körper {0}, nur {1}: Berichtigen Sie ?device= in der Adresse, oder bringen Sie den Körper ins Blickfeld.</translation>
    </message>
    <message>
        <source>The simulation is running behind because this computer is too slow. Lower the rate, or close other programs.</source>
        <translation>Die Simulation bleibt zurück, weil dieser Computer zu langsam ist. Senken Sie die Rate, oder schließen Sie andere Programme.</translation>
    </message>
    <message>
        <source>The source of poses</source>
        <translation>Die Quelle der Posen</translation>
    </message>
    <message>
        <source>The spreads along {0} and {1} are nearly equal ({2} and {3} mm), so the turn about {4} is not determined: fix it by a point or by touches.</source>
        <translation>Die Ausdehnungen entlang {0} und {1} sind fast gleich ({2} und {3} mm), deshalb ist die Drehung um {4} nicht bestimmt: Legen Sie sie durch einen Punkt oder durch Berührungen fest.</translation>
    </message>
    <message>
        <source>The straight joint move to pose {0} is not clear ({1}): go around.</source>
        <translation>Die gerade Gelenkbewegung zu Pose {0} ist nicht frei ({1}): Fahren Sie außen herum.</translation>
    </message>
    <message>
        <source>The surface already has {0} facets and was left unchanged.</source>
        <translation>Die Oberfläche hat schon {0} Facetten und blieb unverändert.</translation>
    </message>
    <message>
        <source>The surface has {0} facets, few enough, and was left unchanged.</source>
        <translation>Die Oberfläche hat {0} Facetten, wenig genug, und blieb unverändert.</translation>
    </message>
    <message>
        <source>The surface has {0}. {1} {2} wide. A line of force can pass through a hole and end on an inner wall, far from the true contact. {3}</source>
        <translation>Die Oberfläche ist offen: {0}. {1} {2} weit. Die Wirkungslinie einer Kraft kann durch ein Loch gehen und an einer Innenwand enden, weit weg vom wahren Kontakt. {3}</translation>
    </message>
    <message>
        <source>The surface has {0}: openings that go right through.</source>
        <translation>Die Oberfläche hat Öffnungen, die ganz hindurchgehen: {0}.</translation>
    </message>
    <message>
        <source>The surface is doubled: behind {0} of the outside lies a second surface, typically {1} away. A force meets two surfaces at once. {2}</source>
        <translation>Die Oberfläche ist doppelt vorhanden. Anteil der Außenseite, hinter dem eine zweite liegt: {0}; Abstand meist {1}. Eine Kraft trifft zwei Oberflächen zugleich. {2}</translation>
    </message>
    <message>
        <source>The surface is open (edges at a hole or gap: {0}). A line of force can pass through and end on an inner wall. Close the outer shell before use.</source>
        <translation>Die Oberfläche ist offen (Kanten an einem Loch oder Spalt: {0}). Die Wirkungslinie einer Kraft kann hindurchgehen und an einer Innenwand enden. Schließen Sie die Außenhülle vor dem Gebrauch.</translation>
    </message>
    <message>
        <source>The surface meets itself in single points (vertices: {0}). Separate the bodies that touch there in the CAD program, or join them. {1}</source>
        <translation>Die Oberfläche trifft in einzelnen Punkten auf sich selbst (Eckpunkte: {0}). Trennen Sie im CAD-Programm die Körper, die sich dort berühren, oder verbinden Sie sie. {1}</translation>
    </message>
    <message>
        <source>The surface of the probe is open or inside out: prepare it again.</source>
        <translation>Die Oberfläche der Sonde ist offen oder umgestülpt: vorbereiten.</translation>
    </message>
    <message>
        <source>The surfaces, of {0} and {1} facets, are at most {2} mm apart.</source>
        <translation>Die Oberflächen, mit {0} und {1} Facetten, sind höchstens {2} mm voneinander entfernt.</translation>
    </message>
    <message>
        <source>The tip slid off the probe and presses nothing. Release it, and touch elsewhere or with less tilt.</source>
        <translation>Die Spitze drückt auf nichts: Sie ist von der Sonde abgerutscht. Lassen Sie los, und berühren Sie anderswo oder mit weniger Neigung.</translation>
    </message>
    <message>
        <source>The tool is moving: hold it still, then press again.</source>
        <translation>Das Werkzeug bewegt sich: Halten Sie es still, und drücken Sie dann noch einmal.</translation>
    </message>
    <message>
        <source>The torques are probably in {0}, not N·m.</source>
        <translation>Die Drehmomente sind vermutlich in {0}, nicht in N·m.</translation>
    </message>
    <message>
        <source>The torques are {0} times what the forces make at the markers: they are in {1}. Divide mx, my and mz by {2}.</source>
        <translation>Die Drehmomente sind {0}-mal so groß wie die, die die Kräfte an den Markern erzeugen: Sie sind in {1}. mx, my und mz durch {2} teilen.</translation>
    </message>
    <message>
        <source>The touches cannot determine {0} better than the {1} mm and {2}° that the mount may be off, so it stays unchanged there. Touch markers whose normals point in other directions, or drag a little so that the forces differ in direction.</source>
        <translation>Die Berührungen können {0} nicht besser zeigen als die {1} mm und {2}°, um die die Montage danebenliegen kann: Dort bleibt sie, wie sie war. Berühren Sie Marker, deren Normalen in andere Richtungen zeigen, oder ziehen Sie ein wenig, damit sich die Richtungen der Kräfte unterscheiden.</translation>
    </message>
    <message>
        <source>The touches move the mount by {0} mm and {1}°, more than its declared uncertainty. Check the first mount, the order of the markers, and the sign of the wrenches.</source>
        <translation>Die Berührungen verschieben die Montage um {0} mm und {1}°, mehr als ihre angegebene Unsicherheit. Prüfen Sie die erste Montage, die Reihenfolge der Marker und das Vorzeichen der Messwerte.</translation>
    </message>
    <message>
        <source>The touches reveal nothing about the mount.</source>
        <translation>Die Berührungen zeigen nichts von der Montage.</translation>
    </message>
    <message>
        <source>The touches scatter {0} times as much as noise and placement explain; all uncertainties have been widened accordingly. Check the compensation, the specified noise and the mesh.</source>
        <translation>Die Berührungen streuen das {0}-Fache dessen, was Rauschen und Platzierung erklären; alle Unsicherheiten wurden entsprechend vergrößert. Prüfen Sie die Kompensation, das angegebene Rauschen und das Netz.</translation>
    </message>
    <message>
        <source>The turned load leaves {0} N of the forces unexplained, but the sensor&apos;s noise is only {1} N: something was touched, or the flange moved fast. The delay may be off by more than its ±. Record again: turn slowly, touch nothing.</source>
        <translation>Die gedrehte Last lässt {0} N der Kräfte unerklärt, das Rauschen des Sensors ist aber nur {1} N: Etwas wurde berührt, oder der Flansch bewegte sich schnell. Der Verzug kann um mehr als sein ± falsch sein. Zeichnen Sie neu auf: langsam drehen, nichts berühren.</translation>
    </message>
    <message>
        <source>The uncertainty is {0} % of the weight; detecting an error of {1} % takes {2} %.</source>
        <translation>Die Unsicherheit beträgt {0} % des Gewichts; um einen Fehler von {1} % zu erkennen, sind {2} % nötig.</translation>
    </message>
    <message>
        <source>The verification does not state its {0}: make sure they match.</source>
        <translation>Angaben, die in der Überprüfung fehlen: {0}. Stellen Sie sicher, dass es diese sind.</translation>
    </message>
    <message>
        <source>The verification does not state its {0}: verify again.</source>
        <translation>Die Überprüfung sagt nicht, womit sie gemacht wurde ({0}): erneut prüfen.</translation>
    </message>
    <message>
        <source>The verification failed: {0}</source>
        <translation>Die Überprüfung ist nicht bestanden: {0}</translation>
    </message>
    <message>
        <source>The verification used another {0}: verify again.</source>
        <translation>Die Überprüfung wurde mit einer anderen Datei gemacht ({0}): erneut prüfen.</translation>
    </message>
    <message>
        <source>The weight hardly loaded {0}: tilt the tool and repeat to check that too.</source>
        <translation>Das Gewicht belastete {0} kaum: das Werkzeug neigen und wiederholen, um auch das zu prüfen.</translation>
    </message>
    <message>
        <source>The weight is probably marked in pounds, or two weights hang on the tool.</source>
        <translation>Vermutlich ist das Gewicht in Pfund beschriftet, oder zwei Gewichte hängen am Werkzeug.</translation>
    </message>
    <message>
        <source>The weight is too small to show a rotation: the forces do not follow the orientations beyond their noise. Mount a heavier load, or average each pose for longer.</source>
        <translation>Das Gewicht ist zu klein, um eine Drehung zu zeigen: Die Kräfte folgen den Orientierungen nicht über ihr Rauschen hinaus. Montieren Sie eine schwerere Last, oder mitteln Sie jede Pose länger.</translation>
    </message>
    <message>
        <source>The wrenches on {0} are in frame {1}, along the axes of the robot&apos;s base. contactbench needs them along the sensor&apos;s: record the sensor&apos;s own topic.</source>
        <translation>Die Wrenches auf {0} sind im System {1} angegeben, also entlang der Achsen der Roboterbasis. contactbench braucht sie entlang der Achsen des Sensors: das Topic des Sensors selbst aufzeichnen.</translation>
    </message>
    <message>
        <source>The wrenches on {0} are in several frames, {1} and {2}: check that they come from one sensor.</source>
        <translation>Die Kräfte und Momente auf {0} stehen in mehreren Koordinatensystemen, {1} und {2}: Sind sie von einem einzigen Sensor?</translation>
    </message>
    <message>
        <source>The zero drifts more than was seen between touches: lift the probe clear for half a second before each, and let the sensor warm up.</source>
        <translation>Der Nullpunkt driftet stärker, als zwischen den Berührungen zu sehen war: Heben Sie die Sonde vor jeder eine halbe Sekunde lang ab, und lassen Sie den Sensor warm werden.</translation>
    </message>
    <message>
        <source>The zero that follows took off {0} N and {1} mN·m of drift, which would move the contacts by {2} mm; {3}; {4}.</source>
        <translation>Der nachgeführte Nullpunkt hat {0} N und {1} mN·m Drift abgezogen, die die Kontakte um {2} mm verschieben würden; {3}; {4}.</translation>
    </message>
    <message>
        <source>The zero was not seen just before {0} of {1} touches ({2}): lift the probe clear for half a second before each.</source>
        <translation>Vor {0} von {1} Berührungen ({2}) wurde der Nullpunkt nicht gesehen: Heben Sie die Sonde vor jeder eine halbe Sekunde lang ab.</translation>
    </message>
    <message>
        <source>The zero was seen before every touch, at most {0} s before.</source>
        <translation>Der Nullpunkt wurde vor jeder Berührung gesehen, höchstens {0} s davor.</translation>
    </message>
    <message>
        <source>The zero was seen: touch the next marker.</source>
        <translation>Der Nullpunkt wurde gesehen: den nächsten Marker berühren.</translation>
    </message>
    <message>
        <source>The {0} do not increase at lines {1}: if {2}, entirely or in some columns, restore the order. Each reading must stand beside its own orientation.</source>
        <translation>Nicht aufsteigend: {0}, in den Zeilen {1}. Falls {2}, ganz oder in einigen Spalten, stellen Sie die Reihenfolge wieder her. Jeder Messwert muss neben seiner eigenen Orientierung stehen.</translation>
    </message>
    <message>
        <source>The {0} have the wrong sign{1}</source>
        <translation>{0} haben das falsche Vorzeichen{1}</translation>
    </message>
    <message>
        <source>The {0} it was computed from is in no earlier record: a record was lost.</source>
        <translation>Was als {0} in die Berechnung einging, steht in keinem früheren Eintrag: Ein Eintrag ging verloren.</translation>
    </message>
    <message>
        <source>The {0} it was computed from was recomputed on {1}.</source>
        <translation>Woraus es berechnet wurde ({0}), wurde am {1} neu berechnet.</translation>
    </message>
    <message>
        <source>The {0} was checked with another {1}: check it again.</source>
        <translation>Geprüft wurde mit anderen Dateien ({0}: {1}): noch einmal prüfen.</translation>
    </message>
    <message>
        <source>The {0} was made with the mounting {1}, but the config has {2}: {3}.</source>
        <translation>Montage laut {0}: {1}, laut Konfiguration: {2}; {3}.</translation>
    </message>
    <message>
        <source>The {0} widest are</source>
        <translation>Die {0} weitesten sind</translation>
    </message>
    <message>
        <source>The {0} {1}</source>
        <translation>Die Eingabe {0} {1}</translation>
    </message>
    <message>
        <source>There are messages of an unknown kind on {0}.</source>
        <translation>Auf {0} gibt es Nachrichten unbekannter Art.</translation>
    </message>
    <message>
        <source>There is no probe to paint on: prepare the probe first.</source>
        <translation>Es gibt keine Sonde zum Bemalen: Bereiten Sie zuerst die Sonde vor.</translation>
    </message>
    <message>
        <source>There is no probe yet: prepare it in step 3, Probe; the regions will be applied to it.</source>
        <translation>Es gibt noch keine Sonde: Bereiten Sie sie in Schritt 3, Sonde, vor; die Regionen werden auf sie angewendet.</translation>
    </message>
    <message>
        <source>There is no {0} yet, so nothing can be exported. {1}</source>
        <translation>Es fehlt noch: {0}; nichts kann exportiert werden. {1}</translation>
    </message>
    <message>
        <source>There is none.</source>
        <translation>Es gibt keinen.</translation>
    </message>
    <message>
        <source>These poses fit equally well as declared and as {0}, so they cannot decide between the two. Turn the wrist about more than one axis between poses.</source>
        <translation>Diese Posen passen gleich gut, ob wie angegeben oder anders gelesen: {0}. Sie können es nicht entscheiden. Drehen Sie das Handgelenk zwischen den Posen um mehr als eine Achse.</translation>
    </message>
    <message>
        <source>These poses show no inconsistency, but they cannot show much:</source>
        <translation>Diese Posen zeigen keinen Widerspruch, aber sie können nicht viel zeigen:</translation>
    </message>
    <message>
        <source>These touches cannot tell which it is; {0}</source>
        <translation>Diese Berührungen können nicht zeigen, welche es ist; {0}</translation>
    </message>
    <message>
        <source>Thin facets fold back onto their neighbours (facets: {0}). {1}</source>
        <translation>Dünne Facetten falten sich auf ihre Nachbarn zurück (Facetten: {0}). {1}</translation>
    </message>
    <message>
        <source>This computer dropped datagrams of the sensor, {0} so far: it was too busy to read them. Close other programs, or allow larger receive buffers (Linux: sysctl net.core.rmem_max).</source>
        <translation>Dieser Rechner hat Datagramme des Sensors verworfen, bisher {0}: Er war zu beschäftigt, um sie zu lesen. Andere Programme schließen oder größere Empfangspuffer erlauben (Linux: sysctl net.core.rmem_max).</translation>
    </message>
    <message>
        <source>This is large: contacts are located less precisely. Find what pulls on the probe or the sensor (cable, hose, cover), warm up the sensor and tighten the mount, then recalibrate and verify again.</source>
        <translation>Das ist viel: Kontakte werden weniger genau geortet. Suchen, was an Sonde oder Sensor zieht (Kabel, Schlauch, Abdeckung), den Sensor warmlaufen lassen, die Halterung festziehen, dann neu kalibrieren und prüfen.</translation>
    </message>
    <message>
        <source>This pose alone is not enough: the contact stays undetermined until another pose follows.</source>
        <translation>Diese Pose allein genügt nicht: Der Kontakt bleibt unbestimmt, bis eine weitere Pose folgt.</translation>
    </message>
    <message>
        <source>This pose is already captured. Turn the tool to the next one.</source>
        <translation>Diese Pose ist schon aufgenommen. Drehen Sie das Werkzeug in die nächste.</translation>
    </message>
    <message>
        <source>This pose is too close to a calibration pose: turn the tool further.</source>
        <translation>Diese Pose liegt zu nahe an einer Kalibrierungspose: Drehen Sie das Werkzeug weiter.</translation>
    </message>
    <message>
        <source>This probe was imported, and the session does not have its mesh: choose the mesh in step 3, Probe, to paint on it.</source>
        <translation>Diese Sonde wurde importiert, und die Sitzung hat ihr Netz nicht: Wählen Sie das Netz in Schritt 3, Sonde, um darauf zu malen.</translation>
    </message>
    <message>
        <source>This session has no recorded poses: record some first.</source>
        <translation>Diese Sitzung hat keine aufgezeichneten Posen: Nehmen Sie zuerst einige auf.</translation>
    </message>
    <message>
        <source>Three points define a frame exactly, so a wrong pick does not show.</source>
        <translation>Drei Punkte legen ein System genau fest, deshalb zeigt sich eine falsche Wahl nicht.</translation>
    </message>
    <message>
        <source>Tilt the wrist about another axis too</source>
        <translation>Neigen Sie das Handgelenk auch um eine andere Achse</translation>
    </message>
    <message>
        <source>Tilt the wrist up to 90° about two axes</source>
        <translation>Neigen Sie das Handgelenk um zwei Achsen bis zu 90°</translation>
    </message>
    <message>
        <source>Too few samples, or none, for {0} s: check the sensor&apos;s plug, connection and rate.</source>
        <translation>Seit {0} s zu wenige Messwerte oder keine: Prüfen Sie Stecker, Verbindung und Rate des Sensors.</translation>
    </message>
    <message>
        <source>Torque limit for the controller.</source>
        <translation>Momentgrenze für die Regelung.</translation>
    </message>
    <message>
        <source>Torques are 1000 times too small, as if N·m had been taken for N·mm and divided once too often</source>
        <translation>Momente sind 1000-mal zu klein, als wäre N·m für N·mm gehalten und einmal zu oft geteilt worden</translation>
    </message>
    <message>
        <source>Torsion that a touch may have, 1 sigma: local torque over force. A hard tip has 0.3, soft tissue 1 to 5.</source>
        <translation>Torsion, die eine Berührung haben darf, 1 Sigma: örtliches Moment durch Kraft. Eine harte Spitze hat 0,3, weiches Gewebe 1 bis 5.</translation>
    </message>
    <message>
        <source>Touch the markers to check that contacts are correct.</source>
        <translation>Berühren Sie die Marker, um zu prüfen, ob Kontakte stimmen.</translation>
    </message>
    <message>
        <source>Touch the markers to verify contacts.</source>
        <translation>Berühren Sie die Marker, um Kontakte zu überprüfen.</translation>
    </message>
    <message>
        <source>Touch threshold</source>
        <translation>Berührschwelle</translation>
    </message>
    <message>
        <source>TouchModel.{0} must be between 0 and 1000 m, not {1}</source>
        <translation>TouchModel.{0} muss zwischen 0 und 1000 m liegen, nicht {1}</translation>
    </message>
    <message>
        <source>Touched: {0}. Remove whatever touches the probe. If nothing does, recalibrate.</source>
        <translation>Berührt: {0}. Entfernen Sie, was die Sonde berührt. Wenn nichts sie berührt, kalibrieren Sie neu.</translation>
    </message>
    <message>
        <source>Touches differ by more than their own noise, and not as a wrong weight, alignment, mesh or marker would make them: hysteresis or creep of the sensor, a dragging cable, or a hand on the handle. More samples do not help. Let the sensor rest between touches, route the cable freely, and hold nothing else.</source>
        <translation>Die Berührungen unterscheiden sich um mehr als ihr eigenes Rauschen, und anders, als es ein falsches Gewicht, eine falsche Ausrichtung, ein falsches Netz oder falsche Marker bewirken: Hysterese oder Kriechen des Sensors, ein schleifendes Kabel oder eine Hand am Griff. Mehr Messwerte helfen nicht. Den Sensor zwischen Berührungen ruhen lassen, das Kabel frei führen und sonst nichts festhalten.</translation>
    </message>
    <message>
        <source>Transfer them from their own mesh instead (contactbench probe regions transfer).</source>
        <translation>Übertragen Sie sie stattdessen von ihrem eigenen Netz (contactbench probe regions transfer).</translation>
    </message>
    <message>
        <source>Turn the mesh by {0}, in --place or with `contactbench probe align`.</source>
        <translation>Das Netz um {0} drehen, in --place oder mit `contactbench probe align`.</translation>
    </message>
    <message>
        <source>Turn the tool to a new pose: {0}. Then keep still.</source>
        <translation>Drehen Sie das Werkzeug in eine neue Pose: {0}. Dann stillhalten.</translation>
    </message>
    <message>
        <source>Turning speed that a controller must never exceed.</source>
        <translation>Drehgeschwindigkeit, die eine Regelung nie überschreiten darf.</translation>
    </message>
    <message>
        <source>Two places, too, where one lies this far off the other&apos;s plane along the force, and half of what it is away in that plane. 0: not asked.</source>
        <translation>Zwei Stellen auch dann, wenn eine so weit entlang der Kraft neben der Ebene der anderen liegt, und dazu die Hälfte ihres Abstands in dieser Ebene. 0: nicht gefragt.</translation>
    </message>
    <message>
        <source>Typed: the mesh&apos;s origin at ({0}, {1}, {2}) mm in the sensor frame, the mesh {3}.</source>
        <translation>Eingegeben: der Ursprung des Netzes bei ({0}, {1}, {2}) mm im Sensorsystem, das Netz {3}.</translation>
    </message>
    <message>
        <source>UR: a tool frame has six finite numbers, not {0}.</source>
        <translation>UR: Ein Werkzeugsystem hat sechs endliche Zahlen, nicht {0}.</translation>
    </message>
    <message>
        <source>UR: a value is not finite: the robot may not be powered.</source>
        <translation>UR: Ein Wert ist nicht endlich: Der Roboter ist vielleicht nicht eingeschaltet.</translation>
    </message>
    <message>
        <source>UR: asked for variables, received {0}. Reconnect.</source>
        <translation>UR: Nach Variablen gefragt, geantwortet: {0}. Neu verbinden.</translation>
    </message>
    <message>
        <source>UR: asked for {0} variables, received {1}. Reconnect.</source>
        <translation>UR: Angefragte Variablen: {0}, beantwortet: {1}. Neu verbinden.</translation>
    </message>
    <message>
        <source>UR: asked for {0}, received {1}. Reconnect.</source>
        <translation>UR: Angefragt: {0}, geantwortet: {1}. Neu verbinden.</translation>
    </message>
    <message>
        <source>UR: data must hold a clock, six joints and a pose of six: reconnect.</source>
        <translation>UR: Die Daten müssen eine Uhr, sechs Gelenke und eine Pose aus sechs Zahlen enthalten: neu verbinden.</translation>
    </message>
    <message>
        <source>UR: received data of recipe {0} instead of {1}. Reconnect.</source>
        <translation>UR: Daten von Rezept {0} statt {1} erhalten. Neu verbinden.</translation>
    </message>
    <message>
        <source>UR: received {0} instead of {1} bytes of data. Reconnect.</source>
        <translation>UR: {0} statt {1} Bytes Daten erhalten. Neu verbinden.</translation>
    </message>
    <message>
        <source>UR: the controller refused the {0} request. Its software may be older than 3.10 or 5.4, or another RTDE client may hold the same variables.</source>
        <translation>UR: Die Steuerung hat die Anfrage {0} abgelehnt. Die Software ist vielleicht älter als 3.10 oder 5.4, oder ein anderer RTDE-Client hält dieselben Variablen.</translation>
    </message>
    <message>
        <source>UR: the variable {0} is {1}: the controller&apos;s software is too old, or another client holds it.</source>
        <translation>UR: Die Variable {0} ist {1}: Die Software dieser Steuerung ist zu alt, oder ein anderer Client hält sie.</translation>
    </message>
    <message>
        <source>UR: variables need plain names, not {0}.</source>
        <translation>UR: Variablen brauchen einfache Namen, nicht {0}.</translation>
    </message>
    <message>
        <source>UR: {0} is not a pose: reconnect.</source>
        <translation>UR: {0} ist keine Pose: neu verbinden.</translation>
    </message>
    <message>
        <source>UR: {0} is not a tool frame: reconnect.</source>
        <translation>UR: {0} ist kein Werkzeugsystem: neu verbinden.</translation>
    </message>
    <message>
        <source>UR: {0} variables are too many for one packet: ask for fewer.</source>
        <translation>UR: {0} Variablen sind zu viele für ein Paket: weniger anfordern.</translation>
    </message>
    <message>
        <source>Uncertainty of the orientations, 1 sigma about each axis: degrees, or their source (robot 0.05, tracker 0.2, hand 0.5) [estimated from the poses].</source>
        <translation>Unsicherheit der Orientierungen, 1 Sigma um jede Achse: in Grad, oder ihre Quelle (robot 0.05, tracker 0.2, hand 0.5) [aus den Posen geschätzt].</translation>
    </message>
    <message>
        <source>Undone: adding {0} {1}. It stays in the session, unused.</source>
        <translation>Rückgängig gemacht, hinzugefügt war: {0} {1}. Es bleibt unbenutzt in der Sitzung.</translation>
    </message>
    <message>
        <source>Unit of the file&apos;s numbers; auto guesses it from the size and says why.</source>
        <translation>Einheit der Zahlen der Datei; auto schließt sie aus der Größe und sagt warum.</translation>
    </message>
    <message>
        <source>Units: {0}. {1}</source>
        <translation>Einheit: {0}. {1}</translation>
    </message>
    <message>
        <source>Unreachable facets left out (inner walls and repeats): {0}.</source>
        <translation>Ausgelassene unerreichbare Facetten (Innenwände und Wiederholungen): {0}.</translation>
    </message>
    <message>
        <source>Until when that certificate is valid; for the report.</source>
        <translation>Bis wann dieser Kalibrierschein gilt; für den Bericht.</translation>
    </message>
    <message>
        <source>Untouched: the mesh is closed and sound.</source>
        <translation>Unverändert: Das Netz ist geschlossen und fehlerfrei.</translation>
    </message>
    <message>
        <source>Unused points that are not numbers were left out (points: {0}).</source>
        <translation>Unbenutzte Punkte, die keine Zahlen sind, wurden ausgelassen (Punkte: {0}).</translation>
    </message>
    <message>
        <source>Usable</source>
        <translation>Brauchbar</translation>
    </message>
    <message>
        <source>Use a finer mesh, or rescan the probe where the markers do not lie on its surface.</source>
        <translation>Verwenden Sie ein feineres Netz, oder scannen Sie die Sonde dort neu, wo die Marker nicht auf ihr liegen.</translation>
    </message>
    <message>
        <source>Usual local torque over the force: hard tip 0.3, soft tissue 1 to 5.</source>
        <translation>Übliches örtliches Moment durch Kraft: harte Spitze 0,3, weiches Gewebe 1 bis 5.</translation>
    </message>
    <message>
        <source>Verification</source>
        <translation>Überprüfung</translation>
    </message>
    <message>
        <source>Verified on {0}.</source>
        <translation>Überprüft am {0}.</translation>
    </message>
    <message>
        <source>Verify first. For trials, an unverified bundle can be exported.</source>
        <translation>Verifizieren Sie zuerst. Für Versuche kann ein ungeprüftes Bundle exportiert werden.</translation>
    </message>
    <message>
        <source>Vertices separated where bodies only met in a point: {0}.</source>
        <translation>Eckpunkte, die getrennt wurden, weil sich Körper nur in ihnen trafen: {0}.</translation>
    </message>
    <message>
        <source>WARNING, should the topic carry the vertical of that frame instead: </source>
        <translation>WARNUNG, falls das Topic stattdessen die Senkrechte jenes Koordinatensystems trägt: </translation>
    </message>
    <message>
        <source>Wait longer in each pose or set a faster filter, and retake the poses with the cables off.</source>
        <translation>Warten Sie in jeder Pose länger, oder stellen Sie einen schnelleren Filter ein, und nehmen Sie die Posen ohne Kabel neu auf.</translation>
    </message>
    <message>
        <source>Waiting for samples.</source>
        <translation>Wartet auf Messwerte.</translation>
    </message>
    <message>
        <source>Warning</source>
        <translation>Warnung</translation>
    </message>
    <message>
        <source>Weakly determined: {0} (1 sigma), little better than before. More touches, or touches on other sides, will help.</source>
        <translation>Schwach bestimmt: {0} (1 Sigma), kaum besser als vorher. Mehr Berührungen, oder Berührungen auf anderen Seiten, würden helfen.</translation>
    </message>
    <message>
        <source>Weigh the tool and give its mass.</source>
        <translation>Wiegen Sie das Werkzeug und geben Sie seine Masse an.</translation>
    </message>
    <message>
        <source>Weight each contact by its confidence, 1 / (1 + the odds of every other place).</source>
        <translation>Jeden Kontakt mit seiner Sicherheit gewichten: 1 / (1 + Quote jedes anderen Ortes).</translation>
    </message>
    <message>
        <source>Weight {0} kg, Cx {1} mm, Cy {2} mm, Cz {3} mm</source>
        <translation>Weight {0} kg, Cx {1} mm, Cy {2} mm, Cz {3} mm</translation>
    </message>
    <message>
        <source>What is touched: dry skin, skin with gel, or what is as hard as bone. Unless it is given, the torsion arm is then 2, 1 or 0.5 mm.</source>
        <translation>Was berührt wird: trockene Haut, Haut mit Gel oder etwas so Hartes wie Knochen. Ist der Torsionsarm nicht angegeben, beträgt er dann 2, 1 oder 0,5 mm.</translation>
    </message>
    <message>
        <source>What q1 to q4 (or q0 to q3) are: wxyz or xyzw; what the first letter of rxx to rzz names: rows of the matrix, or columns, the axes.</source>
        <translation>Was q1 bis q4 (oder q0 bis q3) sind: wxyz oder xyzw; was der erste Buchstabe von rxx bis rzz nennt: Zeilen der Matrix, oder Spalten, die Achsen.</translation>
    </message>
    <message>
        <source>When tracking: forget the last contact after this many samples in a row without an accepted one.</source>
        <translation>Beim Verfolgen: den letzten Kontakt nach so vielen Messwerten in Folge ohne angenommenen vergessen.</translation>
    </message>
    <message>
        <source>When tracking: odds that a touch stays near the previous one rather than jumps.</source>
        <translation>Beim Verfolgen: Chance, dass eine Berührung nahe der vorigen bleibt und nicht springt.</translation>
    </message>
    <message>
        <source>When tracking: prefer places this near the last contact.</source>
        <translation>Beim Verfolgen: Orte so nahe am letzten Kontakt bevorzugen.</translation>
    </message>
    <message>
        <source>Where the probe will be touched, mm in the sensor frame.</source>
        <translation>Wo die Sonde berührt werden wird, mm im Sensorsystem.</translation>
    </message>
    <message>
        <source>Whether a runtime subtracts what the sensor reads in moments without touch (the zero follows).</source>
        <translation>Ob die Laufzeit abzieht, was der Sensor in Momenten ohne Berührung anzeigt (der Nullpunkt folgt).</translation>
    </message>
    <message>
        <source>Whether the torsion arm is learned while a touch is followed, or stays fixed.</source>
        <translation>Ob der Torsionsarm gelernt wird, während eine Berührung verfolgt wird, oder fest bleibt.</translation>
    </message>
    <message>
        <source>Who measured; for the report.</source>
        <translation>Wer gemessen hat; für den Bericht.</translation>
    </message>
    <message>
        <source>Whose controller is to be told.</source>
        <translation>Hersteller der Robotersteuerung.</translation>
    </message>
    <message>
        <source>With an unknown mount, a left-handed sensor frame (one axis with the wrong sign) also looks like gravity that points up.</source>
        <translation>Bei unbekannter Montage sieht auch ein linkshändiges Sensorsystem (eine Achse mit falschem Vorzeichen) wie eine nach oben zeigende Schwerkraft aus.</translation>
    </message>
    <message>
        <source>With these poses it makes no difference.</source>
        <translation>Bei diesen Posen macht es keinen Unterschied.</translation>
    </message>
    <message>
        <source>With {0} poses, none can be checked against the others. Take at least {1}.</source>
        <translation>Bei {0} Posen lässt sich keine an den anderen prüfen. Nehmen Sie mindestens {1} auf.</translation>
    </message>
    <message>
        <source>With {0} {1}.</source>
        <translation>Mit {0} {1}.</translation>
    </message>
    <message>
        <source>Within {0}° (1 sigma {1}°) of a sensor mounted {2}.</source>
        <translation>Bis auf {0}° (1 Sigma {1}°) wie ein so montierter Sensor: {2}.</translation>
    </message>
    <message>
        <source>Without point {0} the others agree within {1} mm rms: check its position.</source>
        <translation>Ohne Punkt {0} stimmen die anderen auf {1} mm rms überein: Prüfen Sie seine Lage.</translation>
    </message>
    <message>
        <source>Without the weight the sensor reads {0} N after compensation: its zero moved since the calibration, or something touched the tool. Recalibrate.</source>
        <translation>Ohne Gewicht misst der Sensor nach der Kompensation {0} N: Sein Nullpunkt hat sich seit der Kalibrierung verschoben, oder etwas hat das Werkzeug berührt. Neu kalibrieren.</translation>
    </message>
    <message>
        <source>Without torque noise and placement error every touch would be infinitely certain: give one of them.</source>
        <translation>Ohne Rauschen der Momente und ohne Platzierungsfehler wäre jede Berührung unendlich sicher: Geben Sie eines davon an.</translation>
    </message>
    <message>
        <source>Wrapped at {0} mm where the surface is torn; the rest keeps its own facets.</source>
        <translation>Umhüllt mit Facetten von {0} mm, wo die Oberfläche zerrissen ist; der Rest behält seine eigenen.</translation>
    </message>
    <message>
        <source>Wrapped at {0} mm. {1}</source>
        <translation>Umhüllt mit Facetten von {0} mm. {1}</translation>
    </message>
    <message>
        <source>WrenchNoise.extra: give a finite (6, 6) covariance of {0}</source>
        <translation>WrenchNoise.extra: eine endliche (6, 6)-Kovarianz angeben, für {0}</translation>
    </message>
    <message>
        <source>WrenchNoise.extra: the covariance has a negative eigenvalue</source>
        <translation>WrenchNoise.extra: Eine Kovarianz hat keinen negativen Eigenwert; diese Matrix hat einen</translation>
    </message>
    <message>
        <source>WrenchNoise.extra: the covariance is not symmetric</source>
        <translation>WrenchNoise.extra: Eine Kovarianz ist symmetrisch; diese Matrix ist es nicht</translation>
    </message>
    <message>
        <source>WrenchNoise.{0}: give one number or three ({1}), not shape {2}</source>
        <translation>WrenchNoise.{0}: eine Zahl oder drei ({1}) angeben, nicht die Form {2}</translation>
    </message>
    <message>
        <source>WrenchNoise.{0}: standard deviations ({1}) must be finite and at least 0, not {2}</source>
        <translation>WrenchNoise.{0}: Standardabweichungen ({1}) müssen endlich und mindestens 0 sein, nicht {2}</translation>
    </message>
    <message>
        <source>Writing a bundle.</source>
        <translation>Ein Paket wird geschrieben.</translation>
    </message>
    <message>
        <source>You can also export the part as 3MF, or as STL in millimetres, with a tolerance of 0.01 mm.</source>
        <translation>Sie können das Teil auch als 3MF oder als STL in Millimetern exportieren, mit einer Toleranz von 0,01 mm.</translation>
    </message>
    <message>
        <source>You left it out.</source>
        <translation>Sie haben sie ausgelassen.</translation>
    </message>
    <message>
        <source>Zero follows: nothing subtracted yet. Lift the probe clear for half a second.</source>
        <translation>Nullpunkt folgt: Noch nichts abgezogen. Die Sonde eine halbe Sekunde frei anheben.</translation>
    </message>
    <message>
        <source>Zero follows: {0}, last seen {1} s ago.</source>
        <translation>Nullpunkt folgt: {0}, zuletzt vor {1} s gesehen.</translation>
    </message>
    <message>
        <source>Zero has stopped following at {0}, last seen {1} s ago: something leans on the probe, or the zero is too far off. Lift the probe clear, or recalibrate.</source>
        <translation>Nullpunkt folgt nicht mehr, Stand {0}, zuletzt vor {1} s gesehen: Etwas lehnt an der Sonde, oder der Nullpunkt ist zu weit weg. Die Sonde frei anheben oder neu kalibrieren.</translation>
    </message>
    <message>
        <source>a &lt;{0}&gt; of the 3MF model has no number ({1}): export it again.</source>
        <translation>ein &lt;{0}&gt; des 3MF-Modells enthält keine Zahl ({1}): Exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>a &lt;{0}&gt; of the 3MF model has no {1}: export it again.</source>
        <translation>einem &lt;{0}&gt; des 3MF-Modells fehlt {1}: Exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>a bandwidth of {0} mm does not suit a probe of {1} mm: choose 0.01 to {2} mm.</source>
        <translation>eine Bandbreite von {0} mm passt nicht zu einer Sonde von {1} mm: 0.01 bis {2} mm wählen.</translation>
    </message>
    <message>
        <source>a bias that changes evenly</source>
        <translation>ein Nullpunktfehler, der sich gleichmäßig ändert</translation>
    </message>
    <message>
        <source>a bump: give a force and a lever of three finite numbers.</source>
        <translation>ein Stoß: Geben Sie Kraft und Hebel mit je drei endlichen Zahlen an.</translation>
    </message>
    <message>
        <source>a bump: give a force of at most {0} N on a lever of at most {1} m.</source>
        <translation>ein Stoß: Geben Sie eine Kraft von höchstens {0} N an einem Hebel von höchstens {1} m an.</translation>
    </message>
    <message>
        <source>a calibration file</source>
        <translation>eine Kalibrierungsdatei</translation>
    </message>
    <message>
        <source>a calibration needs {0}</source>
        <translation>eine Kalibrierung braucht {0}</translation>
    </message>
    <message>
        <source>a channel at its limit</source>
        <translation>ein Kanal an seiner Grenze</translation>
    </message>
    <message>
        <source>a chunk of the GLB file is longer than the file: it is damaged, export it again.</source>
        <translation>ein Block der GLB-Datei ist länger als die Datei: Sie ist beschädigt, exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>a chunk of {0} bytes</source>
        <translation>ein Block von {0} Byte</translation>
    </message>
    <message>
        <source>a chunk that is larger than it says</source>
        <translation>ein Block, der größer ist, als er sagt</translation>
    </message>
    <message>
        <source>a contact at 10 N moves by up to {0} ± {1} mm</source>
        <translation>ein Kontakt bei 10 N verschiebt sich um bis zu {0} ± {1} mm</translation>
    </message>
    <message>
        <source>a delay of {0} s is out of range: give at most {1} s, or auto.</source>
        <translation>ein Verzug von {0} s liegt außerhalb des Bereichs: Geben Sie höchstens {1} s an, oder auto.</translation>
    </message>
    <message>
        <source>a facet has the region {0}, but there may be at most {1}: number them from 1.</source>
        <translation>eine Facette hat die Region {0}, aber höchstens {1} sind erlaubt: Zählen Sie sie ab 1.</translation>
    </message>
    <message>
        <source>a facet of the glTF scene refers to a vertex that does not exist: export it again.</source>
        <translation>eine Facette der glTF-Szene verweist auf einen Eckpunkt, den es nicht gibt: Exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>a facet that lists its vertices</source>
        <translation>eine Facette, die ihre Eckpunkte nennt</translation>
    </message>
    <message>
        <source>a field of {0} bytes in {1} that are left</source>
        <translation>ein Feld von {0} Byte, wo nur {1} übrig sind</translation>
    </message>
    <message>
        <source>a film as .mp4 needs ffmpeg: {0}, or name a file that ends in .gif.</source>
        <translation>ein Film als .mp4 braucht ffmpeg: {0}, oder eine Datei nennen, die auf .gif endet.</translation>
    </message>
    <message>
        <source>a film of {0} minutes is too long: choose a higher speed, or a shorter time window.</source>
        <translation>ein Film von {0} Minuten ist zu lang: ein höheres Tempo oder ein kürzeres Zeitfenster wählen.</translation>
    </message>
    <message>
        <source>a film of {0} s shows no motion: widen the time window, or save a picture.</source>
        <translation>Ein Film von {0} s zeigt nichts, was sich bewegt: Vergrößern Sie das Zeitfenster, oder sichern Sie ein Bild.</translation>
    </message>
    <message>
        <source>a filter that follows changes</source>
        <translation>ein Filter, das Änderungen folgt</translation>
    </message>
    <message>
        <source>a filter that has not settled</source>
        <translation>ein nicht eingeschwungener Filter</translation>
    </message>
    <message>
        <source>a force in N</source>
        <translation>eine Kraft in N</translation>
    </message>
    <message>
        <source>a force of 0.1 N</source>
        <translation>eine Kraft von 0.1 N</translation>
    </message>
    <message>
        <source>a force range needs the forces: give the wrenches that the contacts were located from.</source>
        <translation>ein Kraftbereich braucht die Kräfte: die Kräfte und Momente angeben, aus denen die Kontakte bestimmt wurden.</translation>
    </message>
    <message>
        <source>a grid of {0} mm has {1} points on these facets, but 1 to {2} are allowed: choose another pitch.</source>
        <translation>ein Gitter von {0} mm hat auf diesen Facetten {1} Punkte, erlaubt sind 1 bis {2}: Wählen Sie einen anderen Abstand.</translation>
    </message>
    <message>
        <source>a grid of {0} mm is too fine for this probe: choose a wider one.</source>
        <translation>ein Gitter von {0} mm ist zu fein für diese Sonde: Wählen Sie ein weiteres.</translation>
    </message>
    <message>
        <source>a grid of {0} mm is too fine: give {1} mm or more.</source>
        <translation>ein Gitter von {0} mm ist zu fein: Geben Sie mindestens {1} mm an.</translation>
    </message>
    <message>
        <source>a joint angle is not finite</source>
        <translation>ein Gelenkwinkel ist nicht endlich</translation>
    </message>
    <message>
        <source>a ladder needs rungs: give at least one number of facets.</source>
        <translation>ein Vergleich braucht Stufen: Geben Sie mindestens eine Anzahl Facetten an.</translation>
    </message>
    <message>
        <source>a later record is lost and may have changed its inputs; compute it again</source>
        <translation>ein späterer Eintrag ist verloren und könnte die Eingaben geändert haben; berechnen Sie es erneut</translation>
    </message>
    <message>
        <source>a line is longer than 1 MiB, so this is not a CSV file of {0}: choose another.</source>
        <translation>eine Zeile ist länger als 1 MiB, dies ist also keine CSV-Datei mit {0}: Wählen Sie eine andere.</translation>
    </message>
    <message>
        <source>a link or a device, not a file</source>
        <translation>eine Verknüpfung oder ein Gerät, keine Datei</translation>
    </message>
    <message>
        <source>a list of the PLY element &apos;{0}&apos; announces {1} numbers that the file does not contain: it is damaged or cut short, copy or export it again.</source>
        <translation>eine Liste des PLY-Elements &apos;{0}&apos; kündigt {1} Zahlen an, die die Datei nicht enthält: sie ist beschädigt oder abgeschnitten, neu kopieren oder exportieren.</translation>
    </message>
    <message>
        <source>a matrix of the glTF scene is not a transform of points: export it again.</source>
        <translation>eine Matrix der glTF-Szene ist keine Transformation von Punkten: Exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>a message on channel {0}, which is not described</source>
        <translation>eine Nachricht auf Kanal {0}, der nicht beschrieben ist</translation>
    </message>
    <message>
        <source>a new bias from there on</source>
        <translation>ab dort ein neuer Nullpunktfehler</translation>
    </message>
    <message>
        <source>a node of the glTF scene has several parents, or is its own parent: export it again.</source>
        <translation>ein Knoten der glTF-Szene hat mehrere Eltern oder ist sein eigener: Exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>a number of samples</source>
        <translation>eine Anzahl von Messwerten</translation>
    </message>
    <message>
        <source>a number that is too large</source>
        <translation>eine zu große Zahl</translation>
    </message>
    <message>
        <source>a payload that is taken off</source>
        <translation>einer abgezogenen Nutzlast</translation>
    </message>
    <message>
        <source>a payload that the controller subtracts already</source>
        <translation>eine Nutzlast, die die Steuerung bereits abzieht</translation>
    </message>
    <message>
        <source>a peak is the largest force, so its contacts cannot be weighted: choose another quantity, or turn off confidence weights.</source>
        <translation>ein Spitzenwert ist die größte Kraft, seine Kontakte lassen sich also nicht gewichten: Wählen Sie eine andere Größe, oder gewichten Sie nicht nach Sicherheit.</translation>
    </message>
    <message>
        <source>a placeholder</source>
        <translation>ein Platzhalter</translation>
    </message>
    <message>
        <source>a plan has 3 to {0} poses, not {1}</source>
        <translation>ein Plan hat 3 bis {0} Posen, nicht {1}</translation>
    </message>
    <message>
        <source>a plausible mass</source>
        <translation>eine plausible Masse</translation>
    </message>
    <message>
        <source>a plausible noise</source>
        <translation>ein plausibles Rauschen</translation>
    </message>
    <message>
        <source>a point in the mesh&apos;s frame and the same point in the sensor frame S, mm</source>
        <translation>ein Punkt im System des Netzes und derselbe Punkt im Sensorsystem S, mm</translation>
    </message>
    <message>
        <source>a polygon cannot be triangulated: export the part again with triangles only.</source>
        <translation>ein Vieleck lässt sich nicht in Dreiecke zerlegen: das Teil neu und nur mit Dreiecken exportieren.</translation>
    </message>
    <message>
        <source>a position is more than {0} m away: write x, y, z in metres.</source>
        <translation>eine Position ist mehr als {0} m entfernt: Schreiben Sie x, y, z in Metern.</translation>
    </message>
    <message>
        <source>a position needs all of x, y, z: add the missing columns, or rename the others.</source>
        <translation>eine Position braucht x, y und z: Ergänzen Sie, was fehlt, oder benennen Sie die anderen um.</translation>
    </message>
    <message>
        <source>a pulling cable</source>
        <translation>ein ziehendes Kabel</translation>
    </message>
    <message>
        <source>a record after the {0} {1} is lost and may have noted a re-zeroed sensor; compute it again unless you know that the sensor was not re-zeroed</source>
        <translation>ein Eintrag nach {0} {1} ist verloren und könnte vermerkt haben, dass der Sensor neu genullt wurde; berechnen Sie es erneut, falls das nicht ausgeschlossen ist</translation>
    </message>
    <message>
        <source>a record of {0} bytes</source>
        <translation>ein Datensatz von {0} Bytes</translation>
    </message>
    <message>
        <source>a record of {0} bytes is too large; the limit is {1}: put large data into a file.</source>
        <translation>ein Eintrag von {0} Byte ist zu groß; die Grenze ist {1}: Legen Sie große Daten in einer Datei ab.</translation>
    </message>
    <message>
        <source>a region is called {0} ({1} characters): give it a name of 1 to {2} characters.</source>
        <translation>eine Region heißt {0} ({1} Zeichen): Geben Sie ihr einen Namen mit 1 bis {2} Zeichen.</translation>
    </message>
    <message>
        <source>a rotation of the glTF scene is not a unit quaternion: export it again.</source>
        <translation>eine Drehung der glTF-Szene ist kein Einheitsquaternion: Exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>a runtime config</source>
        <translation>eine Laufzeitkonfiguration</translation>
    </message>
    <message>
        <source>a shift along {0}</source>
        <translation>eine Verschiebung entlang {0}</translation>
    </message>
    <message>
        <source>a shift of {0} mm along {1}</source>
        <translation>eine Verschiebung um {0} mm entlang {1}</translation>
    </message>
    <message>
        <source>a short text</source>
        <translation>ein kurzer Text</translation>
    </message>
    <message>
        <source>a soft pad: it meets no surface, or pulls: touch elsewhere, or with less tilt.</source>
        <translation>ein weiches Kissen: Es trifft keine Oberfläche, oder es zieht: anderswo oder mit weniger Neigung berühren.</translation>
    </message>
    <message>
        <source>a specified noise that is too small, </source>
        <translation>einem zu klein angegebenen Rauschen </translation>
    </message>
    <message>
        <source>a speed of {0}: choose {1} to {2} times.</source>
        <translation>Tempo {0}: das {1}- bis {2}-Fache wählen.</translation>
    </message>
    <message>
        <source>a standard deviation in N</source>
        <translation>eine Standardabweichung in N</translation>
    </message>
    <message>
        <source>a standard deviation in N·m</source>
        <translation>eine Standardabweichung in N·m</translation>
    </message>
    <message>
        <source>a stroke is in progress: finish or cancel it first.</source>
        <translation>gerade wird ein Strich gezogen: Beenden Sie ihn zuerst, oder brechen Sie ihn ab.</translation>
    </message>
    <message>
        <source>a temperature in °C</source>
        <translation>eine Temperatur in °C</translation>
    </message>
    <message>
        <source>a time in s</source>
        <translation>eine Zeit in s</translation>
    </message>
    <message>
        <source>a time window needs contacts with times.</source>
        <translation>ein Zeitfenster braucht Kontakte, deren Zeiten bekannt sind.</translation>
    </message>
    <message>
        <source>a tolerance of {0} m is not valid: give a length above 0.</source>
        <translation>eine Toleranz von {0} m ist nicht gültig: Geben Sie eine Länge über 0 an.</translation>
    </message>
    <message>
        <source>a torque in N·m</source>
        <translation>ein Drehmoment in N·m</translation>
    </message>
    <message>
        <source>a torque of 5 mN·m</source>
        <translation>ein Drehmoment von 5 mN·m</translation>
    </message>
    <message>
        <source>a transform of the 3MF model is not twelve finite numbers: export it again.</source>
        <translation>eine Transformation des 3MF-Modells ist nicht zwölf endliche Zahlen: Exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>a triangle of the 3MF model refers to a vertex that does not exist: export it again.</source>
        <translation>ein Dreieck des 3MF-Modells verweist auf einen Eckpunkt, den es nicht gibt: Exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>a turn about {0}</source>
        <translation>eine Drehung um {0}</translation>
    </message>
    <message>
        <source>a turn of {0}° about {1}</source>
        <translation>eine Drehung um {0}° um {1}</translation>
    </message>
    <message>
        <source>a turned mount</source>
        <translation>eine verdrehte Montage</translation>
    </message>
    <message>
        <source>a typed pose has no host or path</source>
        <translation>eine eingegebene Pose hat weder Host noch Pfad</translation>
    </message>
    <message>
        <source>a vertex of three numbers</source>
        <translation>ein Eckpunkt aus drei Zahlen</translation>
    </message>
    <message>
        <source>a window of {0} s: choose more than 0 s, or none.</source>
        <translation>ein Fenster von {0} s: mehr als 0 s wählen, oder keines.</translation>
    </message>
    <message>
        <source>a {0} packet of {1} bytes</source>
        <translation>ein Paket {0} mit {1} Bytes</translation>
    </message>
    <message>
        <source>above the phantom</source>
        <translation>über dem Phantom</translation>
    </message>
    <message>
        <source>accept</source>
        <translation>annehmen</translation>
    </message>
    <message>
        <source>accepted</source>
        <translation>gezählt</translation>
    </message>
    <message>
        <source>accuracy: {0} m is not above 0 and under 1: give one standard deviation.</source>
        <translation>accuracy: {0} m ist nicht über 0 und unter 1: Geben Sie eine Standardabweichung an.</translation>
    </message>
    <message>
        <source>address {0} has no line: give the address of a device.</source>
        <translation>Adresse {0} hat keine Leitung: die Adresse eines Geräts angeben.</translation>
    </message>
    <message>
        <source>address {0}: a recording and a device have different clocks: give the same recording for sensor and poses, still:// or poses:// beside it, or two devices.</source>
        <translation>Adresse {0}: Aufzeichnung und Gerät haben verschiedene Uhren: Geben Sie dieselbe Aufzeichnung für Sensor und Posen an, dazu still:// oder poses://, oder zwei Geräte.</translation>
    </message>
    <message>
        <source>address {0}: fields: give fx,fy,fz,mx,my,mz of a sensor.</source>
        <translation>Adresse {0}: fields: Geben Sie fx,fy,fz,mx,my,mz eines Sensors an.</translation>
    </message>
    <message>
        <source>address {0}: fields: give qw,qx,qy,qz, rx,ry,rz or q1,q2,... of a robot.</source>
        <translation>Adresse {0}: fields: Geben Sie qw,qx,qy,qz, rx,ry,rz oder q1,q2,... eines Roboters an.</translation>
    </message>
    <message>
        <source>address {0}: it provides no poses: give the address of a robot, a recording, poses:///file.csv or still://?rpy=0,0,0.</source>
        <translation>Adresse {0}: Sie liefert keine Posen: Geben Sie die Adresse eines Roboters, eine Aufzeichnung, poses:///file.csv oder still://?rpy=0,0,0 an.</translation>
    </message>
    <message>
        <source>address {0}: joints: {1}</source>
        <translation>Adresse {0}: joints: {1}</translation>
    </message>
    <message>
        <source>address {0}: not a force/torque sensor. Give the address of a sensor.</source>
        <translation>Adresse {0}: kein Kraft-Momenten-Sensor. Die Adresse eines Sensors angeben.</translation>
    </message>
    <message>
        <source>address {0}: not a force/torque sensor: give the address of a sensor or of a recording.</source>
        <translation>Adresse {0}: kein Kraft-Momenten-Sensor: Geben Sie die Adresse eines solchen oder einer Aufzeichnung an.</translation>
    </message>
    <message>
        <source>address {0}: not a robot. Give the address of a robot.</source>
        <translation>Adresse {0}: kein Roboter. Die Adresse eines Roboters angeben.</translation>
    </message>
    <message>
        <source>address {0}: not the sensor&apos;s bench or clock: give {1} for both.</source>
        <translation>Adresse {0}: ein anderer Messplatz oder eine andere Uhr als beim Sensor: Geben Sie für beide {1} an.</translation>
    </message>
    <message>
        <source>address {0}: robot: {1}</source>
        <translation>Adresse {0}: robot: {1}</translation>
    </message>
    <message>
        <source>address {0}: sensor and poses must come from the same recording at the same speed: give {1} here.</source>
        <translation>Adresse {0}: Sensor und Posen müssen aus derselben Aufzeichnung im selben Tempo kommen: Geben Sie hier {1} an.</translation>
    </message>
    <message>
        <source>address {0}: the driver of {1} failed: {2}. Update the package that it comes from.</source>
        <translation>Adresse {0}: Der Treiber für {1} ist gescheitert: {2}. Aktualisieren Sie das Paket, aus dem er stammt.</translation>
    </message>
    <message>
        <source>address {0}: {1}.</source>
        <translation>Adresse {0}: {1}.</translation>
    </message>
    <message>
        <source>admittance: error {0}, dt {1}: they must be finite, dt positive.</source>
        <translation>Admittanz: Abweichung {0}, dt {1}: Sie müssen endlich sein, dt positiv.</translation>
    </message>
    <message>
        <source>admittance: mass {0}, damping {1}, stiffness {2}: the first two must be positive, the last 0 or more.</source>
        <translation>Admittanz: Masse {0}, Dämpfung {1}, Steifigkeit {2}: Die ersten beiden müssen positiv sein, die letzte mindestens 0.</translation>
    </message>
    <message>
        <source>align it on the Probe page</source>
        <translation>richten Sie sie auf der Seite Sonde aus</translation>
    </message>
    <message>
        <source>all</source>
        <translation>alles</translation>
    </message>
    <message>
        <source>all channels have the wrong sign: the sensor reports the force on its other side</source>
        <translation>alle Kanäle haben das falsche Vorzeichen: Der Sensor gibt die Kraft auf seine andere Seite an</translation>
    </message>
    <message>
        <source>all poses rotate about one axis</source>
        <translation>alle Posen drehen um eine Achse</translation>
    </message>
    <message>
        <source>along the surface</source>
        <translation>entlang der Oberfläche</translation>
    </message>
    <message>
        <source>alpha wrap</source>
        <translation>Alpha-Wrap</translation>
    </message>
    <message>
        <source>alpha {0} mm and gap {1} mm: alpha must be at least {2} mm, the gap at least alpha and at most {3} mm.</source>
        <translation>alpha {0} mm und gap {1} mm: alpha muss mindestens {2} mm sein, gap mindestens alpha und höchstens {3} mm.</translation>
    </message>
    <message>
        <source>an accessor of the glTF scene reaches beyond its data: the file is damaged or cut short, export it again.</source>
        <translation>ein Accessor der glTF-Szene reicht über seine Daten hinaus: Die Datei ist beschädigt oder abgeschnitten, exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>an alignment file</source>
        <translation>eine Ausrichtungsdatei</translation>
    </message>
    <message>
        <source>an installed package</source>
        <translation>einem installierten Paket</translation>
    </message>
    <message>
        <source>an opening of {0}, at ({1}, {2}, {3}) mm</source>
        <translation>eine Öffnung von {0}, bei ({1}, {2}, {3}) mm</translation>
    </message>
    <message>
        <source>an unknown time</source>
        <translation>unbekannt</translation>
    </message>
    <message>
        <source>an unknown unit</source>
        <translation>unbekannt</translation>
    </message>
    <message>
        <source>an unnamed one</source>
        <translation>ein unbenannter</translation>
    </message>
    <message>
        <source>angle_deg: {0} is not above 0 and at most 45.</source>
        <translation>angle_deg: {0} ist nicht über 0 und höchstens 45.</translation>
    </message>
    <message>
        <source>angles</source>
        <translation>Winkel</translation>
    </message>
    <message>
        <source>angles in {0}</source>
        <translation>Winkel in {0}</translation>
    </message>
    <message>
        <source>another plug-in has the same scheme</source>
        <translation>ein anderes Plug-in hat dasselbe Schema</translation>
    </message>
    <message>
        <source>another program is using it: close that program</source>
        <translation>ein anderes Programm benutzt ihn: dieses Programm schließen</translation>
    </message>
    <message>
        <source>another sensor: the calibration belongs to one only</source>
        <translation>ein anderer Sensor: Die Kalibrierung gehört nur zu einem</translation>
    </message>
    <message>
        <source>another surface</source>
        <translation>eine andere Oberfläche</translation>
    </message>
    <message>
        <source>another unit than metres</source>
        <translation>eine andere Einheit als Meter</translation>
    </message>
    <message>
        <source>anywhere</source>
        <translation>überall</translation>
    </message>
    <message>
        <source>are the numbers {0}? Give --units {1} instead of {2}.</source>
        <translation>sind die Zahlen {0}? Geben Sie --units {1} statt {2} an.</translation>
    </message>
    <message>
        <source>array {0} has an impossible shape</source>
        <translation>das Array {0} hat eine unmögliche Form</translation>
    </message>
    <message>
        <source>array {0} is {1}: send float64, an integer or bool</source>
        <translation>Array {0} ist {1}: float64, eine ganze Zahl oder bool senden</translation>
    </message>
    <message>
        <source>as declared</source>
        <translation>wie angegeben</translation>
    </message>
    <message>
        <source>as fast as is useful</source>
        <translation>so schnell, wie es nützt</translation>
    </message>
    <message>
        <source>as many as before, because no smaller number tried keeps the limit</source>
        <translation>so viele wie zuvor, weil keine kleinere Zahl, die versucht wurde, die Grenze einhält</translation>
    </message>
    <message>
        <source>as verified</source>
        <translation>wie geprüft</translation>
    </message>
    <message>
        <source>as verified, if the verification states it</source>
        <translation>wie geprüft, wenn die Prüfung es sagt</translation>
    </message>
    <message>
        <source>assign to {0}</source>
        <translation>zuordnen zu {0}</translation>
    </message>
    <message>
        <source>at most {0} mm, {1} mm RMS, normals {2}° off on average</source>
        <translation>höchstens {0} mm, {1} mm RMS, Normalen im Mittel {2}° daneben</translation>
    </message>
    <message>
        <source>axis_P coincides with origin_P: pick it farther along the axis.</source>
        <translation>axis_P: fällt mit origin_P zusammen: Wählen Sie den Punkt weiter entlang der Achse.</translation>
    </message>
    <message>
        <source>back</source>
        <translation>zurück</translation>
    </message>
    <message>
        <source>bootstrap: give 100 to 1,000,000 resamples and a seed of at least 0.</source>
        <translation>Bootstrap: Geben Sie 100 bis 1,000,000 Stichproben und einen Startwert von mindestens 0 an.</translation>
    </message>
    <message>
        <source>box into</source>
        <translation>Quader in</translation>
    </message>
    <message>
        <source>bump: a lever of {0} m: give at most {1} m.</source>
        <translation>bump: Hebelarm {0} m: Geben Sie höchstens {1} m an.</translation>
    </message>
    <message>
        <source>bump: seconds null: give a positive number, or leave it out.</source>
        <translation>bump: seconds null: Geben Sie eine positive Zahl an, oder lassen Sie es weg.</translation>
    </message>
    <message>
        <source>bump: {0} N: give at most {1} N.</source>
        <translation>bump: {0} N: Geben Sie höchstens {1} N an.</translation>
    </message>
    <message>
        <source>bundle: frames.quaternion_ES is null because its orientations were the sensor&apos;s own: give the rotation of the sensor on the flange.</source>
        <translation>Paket: frames.quaternion_ES ist null, seine Orientierungen waren die des Sensors selbst: angeben, wie der Sensor auf dem Flansch sitzt.</translation>
    </message>
    <message>
        <source>bundle: frames.quaternion_ES is {0}, but {1} was given: leave it out, or recalibrate.</source>
        <translation>Paket: frames.quaternion_ES ist {0}, aber angegeben wurde {1}: weglassen oder neu kalibrieren.</translation>
    </message>
    <message>
        <source>bundle: this would swing. {0}</source>
        <translation>Paket: Das würde schwingen. {0}</translation>
    </message>
    <message>
        <source>calibrate again, or leave out --mount</source>
        <translation>erneut kalibrieren oder --mount weglassen</translation>
    </message>
    <message>
        <source>calibrate in step 2, Gravity</source>
        <translation>kalibrieren Sie in Schritt 2, Schwerkraft</translation>
    </message>
    <message>
        <source>calibrate with that tool again, or use the file as it wrote it.</source>
        <translation>mit jenem Werkzeug neu kalibrieren oder die Datei unverändert verwenden.</translation>
    </message>
    <message>
        <source>candidate_joints: a margin of {0} rad leaves joint {1} no range</source>
        <translation>candidate_joints: Bei einem Abstand von {0} rad zu den Grenzen bleibt kein Spielraum für Gelenk {1}</translation>
    </message>
    <message>
        <source>candidate_joints: count must be at least 1, not {0}</source>
        <translation>candidate_joints: count muss mindestens 1 sein, nicht {0}</translation>
    </message>
    <message>
        <source>candidate_joints: margin must be finite and at least 0 rad, not {0}</source>
        <translation>candidate_joints: margin muss endlich und mindestens 0 rad sein, nicht {0}</translation>
    </message>
    <message>
        <source>candidate_joints: none of {0} configurations near the start is clear; too close: {1}. Move the arm away from there, allow the arm joints to move too, or correct the Clearance.</source>
        <translation>candidate_joints: Keine von {0} Stellungen nahe der Ausgangsstellung ist frei; zu nah: {1}. Bewegen Sie den Arm von dort weg, lassen Sie auch die Armgelenke sich bewegen, oder berichtigen Sie Clearance.</translation>
    </message>
    <message>
        <source>candidate_joints: {0} must be finite and above 0 rad, not {1}</source>
        <translation>candidate_joints: {0} muss endlich sein und über 0 rad liegen, nicht {1}</translation>
    </message>
    <message>
        <source>centimetres</source>
        <translation>Zentimeter</translation>
    </message>
    <message>
        <source>check Orientation on the Devices page</source>
        <translation>prüfen Sie „Orientierung“ auf der Seite Geräte</translation>
    </message>
    <message>
        <source>check address and kind of the device</source>
        <translation>Adresse und Art des Geräts prüfen</translation>
    </message>
    <message>
        <source>check cable, address and power</source>
        <translation>Kabel, Adresse und Stromversorgung prüfen</translation>
    </message>
    <message>
        <source>check that the device is on, and on this network</source>
        <translation>prüfen, ob das Gerät eingeschaltet und in diesem Netzwerk ist</translation>
    </message>
    <message>
        <source>check the address</source>
        <translation>Adresse prüfen</translation>
    </message>
    <message>
        <source>check the option angle of the address</source>
        <translation>prüfen Sie die Option angle der Adresse</translation>
    </message>
    <message>
        <source>check the path and the speed, and that the device is plugged in</source>
        <translation>Pfad und Geschwindigkeit prüfen, und ob es eingesteckt ist</translation>
    </message>
    <message>
        <source>check the {0} again</source>
        <translation>noch einmal prüfen ({0})</translation>
    </message>
    <message>
        <source>choose Open up to the damage</source>
        <translation>wählen Sie „Bis zum Schaden öffnen“</translation>
    </message>
    <message>
        <source>choose Reload session in the File menu</source>
        <translation>wählen Sie „Sitzung neu laden“ im Menü Datei</translation>
    </message>
    <message>
        <source>choose Salvage a copy, or restore a backup</source>
        <translation>wählen Sie „Kopie retten“, oder spielen Sie eine Sicherung ein</translation>
    </message>
    <message>
        <source>choose a file written by `contactbench calibrate check {0} --out`.</source>
        <translation>eine Datei wählen, die mit `contactbench calibrate check {0} --out` geschrieben wurde.</translation>
    </message>
    <message>
        <source>choose one of {0}</source>
        <translation>eines davon wählen: {0}</translation>
    </message>
    <message>
        <source>clock_deg: {0} is not within ±360 degrees.</source>
        <translation>clock_deg: {0} ist nicht innerhalb von ±360 Grad.</translation>
    </message>
    <message>
        <source>closed by a smooth surface</source>
        <translation>mit glatter Fläche geschlossen</translation>
    </message>
    <message>
        <source>closed by straight lines between its long rims</source>
        <translation>mit geraden Linien zwischen den langen Rändern geschlossen</translation>
    </message>
    <message>
        <source>closed by the hull of its rim</source>
        <translation>mit der Hülle des Rands geschlossen</translation>
    </message>
    <message>
        <source>closed loop</source>
        <translation>geschlossener Regelkreis</translation>
    </message>
    <message>
        <source>closed loop: nothing has happened yet: run at least one step.</source>
        <translation>Regelkreis: Noch ist nichts geschehen: mindestens einen Schritt weitergehen.</translation>
    </message>
    <message>
        <source>closed loop: {0} s: give a time above 0, up to {1} s.</source>
        <translation>Regelkreis: {0} s: eine Zeit über 0 und bis {1} s angeben.</translation>
    </message>
    <message>
        <source>closed part lies</source>
        <translation>geschlossenes Teil liegt</translation>
    </message>
    <message>
        <source>closed parts lie</source>
        <translation>geschlossene Teile liegen</translation>
    </message>
    <message>
        <source>column</source>
        <translation>Spalte</translation>
    </message>
    <message>
        <source>column t runs backwards or jumps far: sort the rows by time, and write seconds.</source>
        <translation>Spalte t geht zurück oder springt weit: Sortieren Sie die Zeilen nach der Zeit, und schreiben Sie Sekunden.</translation>
    </message>
    <message>
        <source>column t runs backwards, from {0} to {1} s: sort the rows by time, or cut the table where the clock was set back.</source>
        <translation>Spalte t läuft rückwärts, von {0} nach {1} s: Sortieren Sie die Zeilen nach der Zeit, oder trennen Sie die Tabelle dort, wo die Uhr zurückgestellt wurde.</translation>
    </message>
    <message>
        <source>column t runs from {0} to {1} in steps of {2}, which looks like {3}, not s: name the column t_{4}, or write s.</source>
        <translation>Spalte t reicht von {0} bis {1} in Schritten von {2}. Das sieht nach {3} aus, nicht nach s: die Spalte t_{4} nennen oder s schreiben.</translation>
    </message>
    <message>
        <source>column {0} holds {1}</source>
        <translation>Spalte {0} enthält {1}</translation>
    </message>
    <message>
        <source>column {0} holds {1}, but {2} lies between {3} and {4}</source>
        <translation>Spalte {0} enthält {1}, aber {2} liegt zwischen {3} und {4}</translation>
    </message>
    <message>
        <source>column {0} is empty in {1}</source>
        <translation>Spalte {0} ist in {1} leer</translation>
    </message>
    <message>
        <source>column {0} is empty or no number, and no row is complete: fill in the cells, or choose another file.</source>
        <translation>Spalte {0} ist leer oder keine Zahl, und keine Zeile ist vollständig: Füllen Sie die Zellen aus, oder wählen Sie eine andere Datei.</translation>
    </message>
    <message>
        <source>column {0} is empty: give {1}, or none of them.</source>
        <translation>Spalte {0} ist leer: Geben Sie {1} an, oder keine davon.</translation>
    </message>
    <message>
        <source>column {0} is empty: {1}</source>
        <translation>Spalte {0} ist leer: {1}</translation>
    </message>
    <message>
        <source>column {0} is in {1}, a unit that is not known: write it in N, N·m or s, and change the header.</source>
        <translation>Spalte {0} steht in {1}, einer unbekannten Einheit: Schreiben Sie sie in N, N·m oder s, und ändern Sie die Kopfzeile.</translation>
    </message>
    <message>
        <source>column {0} missing: give {1}, or none of them.</source>
        <translation>Spalte {0} fehlt: Geben Sie {1} an, oder keine davon.</translation>
    </message>
    <message>
        <source>column {0} occurs {1} times: keep one and rename the others.</source>
        <translation>Spalte {0} kommt {1}-mal vor: Behalten Sie eine, und benennen Sie die anderen um.</translation>
    </message>
    <message>
        <source>column {0} {1}</source>
        <translation>Spalte {0} {1}</translation>
    </message>
    <message>
        <source>columns</source>
        <translation>Spalten</translation>
    </message>
    <message>
        <source>columns {0} alone do not define the orientation: pass {1}.</source>
        <translation>die Spalten {0} allein legen die Orientierung nicht fest: Geben Sie an: {1}.</translation>
    </message>
    <message>
        <source>column{0} {1}: this is a raw recording that includes the tool&apos;s weight and the sensor&apos;s offset. Compensate it first: contactbench calibrate compensate calibration.json RECORDING --out WRENCHES; or pass --compensated if that is done.</source>
        <translation>Spalte{0} {1}: Das ist eine Rohaufzeichnung, sie enthält Werkzeuggewicht und Sensor-Nullpunkt. Zuerst kompensieren: contactbench calibrate compensate calibration.json RECORDING --out WRENCHES; oder --compensated angeben, wenn das geschehen ist.</translation>
    </message>
    <message>
        <source>compensate: wrench {0} and R_WS {1} do not fit: give (6,) with (3, 3), or (n, 6) with (3, 3) or (n, 3, 3)</source>
        <translation>compensate: wrench {0} und R_WS {1} passen nicht zusammen: Geben Sie (6,) mit (3, 3) an, oder (n, 6) mit (3, 3) oder (n, 3, 3)</translation>
    </message>
    <message>
        <source>complete or remove the pose.</source>
        <translation>Vervollständigen oder entfernen Sie die Pose.</translation>
    </message>
    <message>
        <source>conflict: moving needs the shape {0}, not {1}</source>
        <translation>conflict: moving braucht die Form {0}, nicht {1}</translation>
    </message>
    <message>
        <source>contact density</source>
        <translation>Kontaktdichte</translation>
    </message>
    <message>
        <source>contactbench has a driver of that scheme itself</source>
        <translation>contactbench hat selbst einen Treiber mit diesem Schema</translation>
    </message>
    <message>
        <source>control settings: max_tilt is {0} rad: give less than a quarter turn, 1.57.</source>
        <translation>Einstellungen der Regelung: max_tilt ist {0} rad: weniger als eine Vierteldrehung angeben, 1.57.</translation>
    </message>
    <message>
        <source>control settings: the wanted force of {0} N must be above {1} N and below 80 % of the limit of {2} N: change one of them.</source>
        <translation>Einstellungen der Regelung: Eine gewollte Kraft von {0} N muss über {1} N und unter 80 % der Grenze von {2} N liegen: eine davon ändern.</translation>
    </message>
    <message>
        <source>control settings: variant is {0}: give one of {1}.</source>
        <translation>Reglereinstellungen: variant ist {0}: eines von {1} angeben.</translation>
    </message>
    <message>
        <source>control settings: {0} is {1}: give positive, finite numbers.</source>
        <translation>Einstellungen der Regelung: {0} ist {1}: positive, endliche Zahlen angeben.</translation>
    </message>
    <message>
        <source>controller: not the fields {0}</source>
        <translation>controller: nicht die Felder {0}</translation>
    </message>
    <message>
        <source>controller: {0} joints for an arm that has {1}: give all of them.</source>
        <translation>Regelung: Gelenke {0} bei einem Arm mit {1}: alle angeben.</translation>
    </message>
    <message>
        <source>copy or export the bundle again.</source>
        <translation>das Paket erneut kopieren oder exportieren.</translation>
    </message>
    <message>
        <source>correct or remove the row.</source>
        <translation>berichtigen oder entfernen Sie die Zeile.</translation>
    </message>
    <message>
        <source>count is {0}: a mean needs at least one sample, and a whole number of them</source>
        <translation>count ist {0}: Ein Mittelwert braucht mindestens einen Messwert, und eine ganze Zahl davon</translation>
    </message>
    <message>
        <source>counts per N</source>
        <translation>Zählschritte pro N</translation>
    </message>
    <message>
        <source>counts per N·m</source>
        <translation>Zählschritte pro N·m</translation>
    </message>
    <message>
        <source>covariance, about_S: give both or neither.</source>
        <translation>covariance, about_S: Geben Sie beide an oder keines.</translation>
    </message>
    <message>
        <source>covariance: it is not symmetric with no negative eigenvalue: align again.</source>
        <translation>covariance: nicht symmetrisch ohne negative Eigenwerte: Richten Sie neu aus.</translation>
    </message>
    <message>
        <source>created has no time zone</source>
        <translation>created hat keine Zeitzone</translation>
    </message>
    <message>
        <source>crosstalk</source>
        <translation>Übersprechen</translation>
    </message>
    <message>
        <source>cut along crossings</source>
        <translation>an Durchdringungen zerteilen</translation>
    </message>
    <message>
        <source>deg: bend of the head against the handle.</source>
        <translation>Grad: Der Kopf ist gegen den Griff gebogen.</translation>
    </message>
    <message>
        <source>deg: error of the probe&apos;s declared rotation, with a shift of 1 mm per degree.</source>
        <translation>Grad: Fehler der angegebenen Drehung der Sonde, mit 1 mm Verschiebung je Grad.</translation>
    </message>
    <message>
        <source>deg: tilt of the pad on the surface.</source>
        <translation>Grad: So schief steht das Kissen auf der Oberfläche.</translation>
    </message>
    <message>
        <source>degraded: the force is {0} N.</source>
        <translation>verschlechtert: Die Kraft beträgt {0} N.</translation>
    </message>
    <message>
        <source>device {0}: {1}.</source>
        <translation>Gerät {0}: {1}.</translation>
    </message>
    <message>
        <source>devices.mount: set it to three angles, degrees about the fixed axes x, y, z.</source>
        <translation>devices.mount: Setzen Sie es auf drei Winkel, in Grad um die festen Achsen x, y, z.</translation>
    </message>
    <message>
        <source>did not answer</source>
        <translation>hat nicht geantwortet</translation>
    </message>
    <message>
        <source>died ({0})</source>
        <translation>ist abgestürzt ({0})</translation>
    </message>
    <message>
        <source>do not match cutoff_Hz, order and rate_Hz.</source>
        <translation>sind nicht die, die zu cutoff_Hz, order und rate_Hz gehören.</translation>
    </message>
    <message>
        <source>do {0}: choose one of {1}.</source>
        <translation>do {0}: Wählen Sie eines von diesen: {1}.</translation>
    </message>
    <message>
        <source>does not count</source>
        <translation>zählt nicht</translation>
    </message>
    <message>
        <source>does not follow from the noise of a reading, the filter and gravity.covariance.</source>
        <translation>ist nicht das, was das Rauschen eines Messwerts, der Filter und gravity.covariance zusammen ergeben.</translation>
    </message>
    <message>
        <source>done</source>
        <translation>erledigt</translation>
    </message>
    <message>
        <source>down in it is {0}</source>
        <translation>unten ist darin {0}</translation>
    </message>
    <message>
        <source>down_W is {0}: give the direction of gravity in the world frame, three finite numbers that are not all 0, such as 0,0,-1</source>
        <translation>down_W ist {0}: Geben Sie die Richtung der Schwerkraft im Weltsystem an, drei endliche Zahlen, die nicht alle 0 sind, etwa 0,0,-1</translation>
    </message>
    <message>
        <source>drift explains {0} % of what is left</source>
        <translation>Drift erklärt {0} % vom Rest</translation>
    </message>
    <message>
        <source>drifting zero</source>
        <translation>driftender Nullpunkt</translation>
    </message>
    <message>
        <source>edge</source>
        <translation>Kante</translation>
    </message>
    <message>
        <source>edge collapse</source>
        <translation>Zusammenfassen von Kanten</translation>
    </message>
    <message>
        <source>edges</source>
        <translation>Kanten</translation>
    </message>
    <message>
        <source>emulated {0}: it failed: {1}.</source>
        <translation>emuliert: {0}, gescheitert: {1}.</translation>
    </message>
    <message>
        <source>encrypted or packed in an unusual way</source>
        <translation>verschlüsselt oder auf unübliche Weise gepackt</translation>
    </message>
    <message>
        <source>ended without a sample</source>
        <translation>endete ohne Messwert</translation>
    </message>
    <message>
        <source>estimate_mount: use contactbench.pipeline.calibration.mount.estimate_mount, which returns it.</source>
        <translation>estimate_mount: nehmen Sie contactbench.pipeline.calibration.mount.estimate_mount, das die Montage zurückgibt.</translation>
    </message>
    <message>
        <source>everything between {0} and {1} is static.</source>
        <translation>alles zwischen {0} und {1} ist statisch.</translation>
    </message>
    <message>
        <source>exit code {0}</source>
        <translation>Exit-Code {0}</translation>
    </message>
    <message>
        <source>expands more than {0} times when unpacked</source>
        <translation>wächst beim Entpacken auf mehr als das {0}-Fache</translation>
    </message>
    <message>
        <source>export it again as GLB without compression, or as STL or 3MF</source>
        <translation>exportieren Sie sie neu als GLB ohne Kompression, oder als STL oder 3MF</translation>
    </message>
    <message>
        <source>export the config again.</source>
        <translation>die Konfiguration erneut exportieren.</translation>
    </message>
    <message>
        <source>faces must be integers, not {0}: convert the vertex indices to int32.</source>
        <translation>faces müssen ganze Zahlen sein, nicht {0}: die Indizes der Eckpunkte in int32 umwandeln.</translation>
    </message>
    <message>
        <source>faces must have shape (m, 3), not {0}: split polygons into triangles.</source>
        <translation>faces müssen die Form (m, 3) haben, nicht {0}: Vielecke in Dreiecke zerlegen.</translation>
    </message>
    <message>
        <source>faces: row {0} refers to vertex {1}, but the indices run from 0 to {2}. Count vertices from 0, and export the mesh again if it was cut short.</source>
        <translation>faces: Zeile {0} nennt den Eckpunkt {1}, aber die Indizes gehen von 0 bis {2}. Eckpunkte ab 0 zählen, und das Netz neu exportieren, falls es abgeschnitten wurde.</translation>
    </message>
    <message>
        <source>faces: row {0} {1} {2}; {3} of {4} facets have no area. Remove them, or read the mesh with load_probe, which leaves a few of them out.</source>
        <translation>faces: Zeile {0} {1} {2}; {3} von {4} Facetten haben keine Fläche. Entfernen Sie sie, oder lesen Sie das Netz mit load_probe, das einige wenige auslässt.</translation>
    </message>
    <message>
        <source>faces: there are no facets: give at least one.</source>
        <translation>faces: es gibt keine Facetten: mindestens eine angeben.</translation>
    </message>
    <message>
        <source>facet</source>
        <translation>Facette</translation>
    </message>
    <message>
        <source>facet is a duplicate</source>
        <translation>Facette ist ein Duplikat</translation>
    </message>
    <message>
        <source>facet stands</source>
        <translation>Facette steht</translation>
    </message>
    <message>
        <source>facet {0} does not exist: they run from 0 to {1}.</source>
        <translation>Facette {0} gibt es nicht: Die Facetten gehen von 0 bis {1}.</translation>
    </message>
    <message>
        <source>facet {0} has the region {1}, but there are {2} regions: add the missing ones, or use ranks from 0.</source>
        <translation>Facette {0} hat die Region {1}, aber es gibt {2} Regionen: Fügen Sie die fehlenden hinzu, oder verwenden Sie Ränge ab 0.</translation>
    </message>
    <message>
        <source>facet: {0} is not between 0 and {1}: pick a facet of the mesh.</source>
        <translation>facet: {0} ist nicht zwischen 0 und {1}: Wählen Sie eine des Netzes.</translation>
    </message>
    <message>
        <source>facets</source>
        <translation>Facetten</translation>
    </message>
    <message>
        <source>facets and regions</source>
        <translation>Facetten und Regionen</translation>
    </message>
    <message>
        <source>facets are duplicates</source>
        <translation>Facetten sind Duplikate</translation>
    </message>
    <message>
        <source>facets are {0} of shape {1}: give their numbers, or one bool per facet.</source>
        <translation>die Facetten sind {0} der Form {1}: Geben Sie ihre Nummern an, oder einen bool je Facette.</translation>
    </message>
    <message>
        <source>facets stand</source>
        <translation>Facetten stehen</translation>
    </message>
    <message>
        <source>failed</source>
        <translation>gescheitert</translation>
    </message>
    <message>
        <source>fall</source>
        <translation>fallen</translation>
    </message>
    <message>
        <source>far from every marker</source>
        <translation>weit weg von jedem Marker</translation>
    </message>
    <message>
        <source>fault {0}: not available for {1}. Choose from {2}.</source>
        <translation>Störung {0}: für {1} nicht verfügbar. Möglich: {2}.</translation>
    </message>
    <message>
        <source>fault {0}: size {1}: give a finite number, positive for a rate.</source>
        <translation>Störung {0}: Größe {1}: eine endliche Zahl angeben, positiv bei einer Rate.</translation>
    </message>
    <message>
        <source>fault {0}: start {1} s, duration {2} s: give a start of 0 or more and a positive duration.</source>
        <translation>Störung {0}: Beginn {1} s, Dauer {2} s: einen Beginn von mindestens 0 und eine positive Dauer angeben.</translation>
    </message>
    <message>
        <source>fault {0}: write it as NAME@START+DURATION in s, such as stall@2+0.5. Names: {1}.</source>
        <translation>Störung {0}: NAME@START+DURATION in s schreiben, etwa stall@2+0.5; Namen: {1}.</translation>
    </message>
    <message>
        <source>fault {0}: {1}. Write the numbers as in stall@2+0.5.</source>
        <translation>Störung {0}: {1}: die Zahlen so schreiben wie in stall@2+0.5.</translation>
    </message>
    <message>
        <source>feet</source>
        <translation>Fuß</translation>
    </message>
    <message>
        <source>fields: give fx,fy,fz,mx,my,mz of a sensor, or of a robot qw,qx,qy,qz, rx,ry,rz or q1,q2,...</source>
        <translation>fields: Geben Sie fx,fy,fz,mx,my,mz eines Sensors an, oder von einem Roboter qw,qx,qy,qz, rx,ry,rz oder q1,q2,...</translation>
    </message>
    <message>
        <source>fields: give one of a quaternion, rx,ry,rz and joints</source>
        <translation>fields: Geben Sie nur eines an: Quaternion, rx,ry,rz oder Gelenke</translation>
    </message>
    <message>
        <source>fields: joints begin at q1, without a gap</source>
        <translation>fields: Die Gelenke beginnen bei q1, ohne Lücke</translation>
    </message>
    <message>
        <source>fields: say what the columns are, as in fields=t,fx,fy,fz,mx,my,mz, or name a file that does with layout</source>
        <translation>fields: Geben Sie an, was die Spalten sind, etwa fields=t,fx,fy,fz,mx,my,mz, oder mit layout eine Datei, in der das steht</translation>
    </message>
    <message>
        <source>fields: {0} missing: give all of {1}</source>
        <translation>fields: {0} fehlen: Geben Sie alle an: {1}</translation>
    </message>
    <message>
        <source>filter</source>
        <translation>filtern</translation>
    </message>
    <message>
        <source>filters.location.order is {0}: a runtime supports at most {1}.</source>
        <translation>filters.location.order ist {0}: Ein Robotercomputer nimmt höchstens {1}.</translation>
    </message>
    <message>
        <source>force out of window</source>
        <translation>Kraft außerhalb des Fensters</translation>
    </message>
    <message>
        <source>force window {0} to {1} N: the lower end must be above {2} N, where a touch begins, and below the upper end.</source>
        <translation>Kraftfenster {0} bis {1} N: Das untere Ende muss über {2} N liegen, wo eine Berührung beginnt, und unter dem oberen.</translation>
    </message>
    <message>
        <source>force {0} sigma ({1} N) off</source>
        <translation>Kraft {0} Sigma ({1} N) daneben</translation>
    </message>
    <message>
        <source>forces</source>
        <translation>Kräfte</translation>
    </message>
    <message>
        <source>forces and torques</source>
        <translation>Kräfte und Momente</translation>
    </message>
    <message>
        <source>forces and torques are in kgf and kgf·mm, not N and N·m</source>
        <translation>Kräfte und Drehmomente sind in kgf und kgf·mm, nicht in N und N·m</translation>
    </message>
    <message>
        <source>forces and torques are in lbf and lbf·in, not N and N·m</source>
        <translation>Kräfte und Drehmomente sind in lbf und lbf·in, nicht in N und N·m</translation>
    </message>
    <message>
        <source>forces in N, torques in N·m, in the sensor frame S</source>
        <translation>Kräfte in N, Momente in N·m, im Sensorsystem S</translation>
    </message>
    <message>
        <source>forces with torques</source>
        <translation>Kräfte mit Momenten</translation>
    </message>
    <message>
        <source>forward</source>
        <translation>vor</translation>
    </message>
    <message>
        <source>frames.world is {0}, not &apos;W, z up&apos;</source>
        <translation>frames.world ist {0}, nicht &apos;W, z up&apos;</translation>
    </message>
    <message>
        <source>from a clock that went back</source>
        <translation>Uhr lief zurück</translation>
    </message>
    <message>
        <source>from the poses</source>
        <translation>aus den Posen</translation>
    </message>
    <message>
        <source>from {0} s on</source>
        <translation>ab {0} s</translation>
    </message>
    <message>
        <source>from {0} to {1} s</source>
        <translation>von {0} bis {1} s</translation>
    </message>
    <message>
        <source>ft_calib_yaml: com_frame and child_frame are both {0}: tf needs two names</source>
        <translation>ft_calib_yaml: com_frame und child_frame sind beide {0}: tf braucht zwei Namen</translation>
    </message>
    <message>
        <source>ft_calib_yaml: the load has no weight that points down, and gravity_compensation takes no mass of zero. Subtract the bias alone, or calibrate with the load mounted.</source>
        <translation>ft_calib_yaml: Die Last hat kein Gewicht, das nach unten zeigt, und gravity_compensation nimmt keine Masse von null an. Ziehen Sie nur den Nullpunktfehler ab, oder kalibrieren Sie mit montierter Last.</translation>
    </message>
    <message>
        <source>fully retracted.</source>
        <translation>sie ist zurückgegangen.</translation>
    </message>
    <message>
        <source>further from the mesh origin</source>
        <translation>weiter weg vom Ursprung des Netzes</translation>
    </message>
    <message>
        <source>f{0} and m{1}</source>
        <translation>f{0} und m{1}</translation>
    </message>
    <message>
        <source>f{0} and m{1} negated</source>
        <translation>f{0} und m{1} negiert</translation>
    </message>
    <message>
        <source>gates: {0}. {1}</source>
        <translation>gates: {0}. {1}</translation>
    </message>
    <message>
        <source>get permission to use serial ports (on Linux: the group dialout), or close the other program</source>
        <translation>die Berechtigung für serielle Anschlüsse beschaffen (unter Linux: die Gruppe dialout) oder das andere Programm schließen</translation>
    </message>
    <message>
        <source>give a date as 2027-03-31</source>
        <translation>geben Sie ein Datum wie 2027-03-31 an</translation>
    </message>
    <message>
        <source>give a host, and a path that begins with /</source>
        <translation>einen Host angeben und einen Pfad, der mit / beginnt</translation>
    </message>
    <message>
        <source>give a positive number of {0}</source>
        <translation>eine positive Zahl angeben, Einheit: {0}</translation>
    </message>
    <message>
        <source>give a unit ({0}) or how many {1} one is, such as -1 to change the sign</source>
        <translation>geben Sie eine Einheit an ({0}), oder wie viele {1} eine ist, etwa -1, um das Vorzeichen zu ändern</translation>
    </message>
    <message>
        <source>give a whole number from 1 to 65535</source>
        <translation>eine ganze Zahl von 1 bis 65535 angeben</translation>
    </message>
    <message>
        <source>give a whole number of 0 or more</source>
        <translation>eine ganze Zahl ab 0 angeben</translation>
    </message>
    <message>
        <source>give a whole number of bit/s such as 115200</source>
        <translation>eine ganze Zahl in bit/s angeben, etwa 115200</translation>
    </message>
    <message>
        <source>give at most {0}</source>
        <translation>geben Sie höchstens {0} an</translation>
    </message>
    <message>
        <source>give at most {0} printable characters; \r and \n end a line</source>
        <translation>geben Sie höchstens {0} druckbare Zeichen an; \r und \n beenden eine Zeile</translation>
    </message>
    <message>
        <source>give degrees, at least 0, or one of {0}</source>
        <translation>Grad angeben, mindestens 0, oder eines von {0}</translation>
    </message>
    <message>
        <source>give its name, or leave the option out</source>
        <translation>den Namen angeben oder die Option weglassen</translation>
    </message>
    <message>
        <source>give names alone for columns, or a key after each, as in fx:force.x, for JSON</source>
        <translation>geben Sie für Spalten nur Namen an, für JSON nach jedem einen Schlüssel, etwa fx:force.x</translation>
    </message>
    <message>
        <source>give seconds, or auto</source>
        <translation>Sekunden angeben, oder auto</translation>
    </message>
    <message>
        <source>give some of {0}</source>
        <translation>geben Sie einige von {0} an</translation>
    </message>
    <message>
        <source>give step, or leave the option out for real time</source>
        <translation>step angeben, oder die Option für Echtzeit weglassen</translation>
    </message>
    <message>
        <source>give the distance, either in rings of facets or as a length.</source>
        <translation>geben Sie die Weite an, entweder in Ringen von Facetten oder als Länge.</translation>
    </message>
    <message>
        <source>give {0} numbers separated by commas, none beyond {1}</source>
        <translation>{0} Zahlen angeben, durch Kommas getrennt, keine jenseits von {1}</translation>
    </message>
    <message>
        <source>go back</source>
        <translation>zurückziehen</translation>
    </message>
    <message>
        <source>good</source>
        <translation>gut</translation>
    </message>
    <message>
        <source>gravity along {0} of the world</source>
        <translation>Schwerkraft entlang {0} der Welt</translation>
    </message>
    <message>
        <source>gravity in that direction</source>
        <translation>Schwerkraft in dieser Richtung</translation>
    </message>
    <message>
        <source>gravity points down</source>
        <translation>die Schwerkraft zeigt nach unten</translation>
    </message>
    <message>
        <source>gravity points {0}° away from down</source>
        <translation>die Schwerkraft zeigt {0}° neben senkrecht nach unten</translation>
    </message>
    <message>
        <source>gravity would point {0}° away from down</source>
        <translation>die Schwerkraft würde {0}° neben senkrecht nach unten zeigen</translation>
    </message>
    <message>
        <source>gravity would point {0}° away from down; read this way, {1}°</source>
        <translation>die Schwerkraft würde {0}° neben senkrecht nach unten zeigen, so gelesen {1}°</translation>
    </message>
    <message>
        <source>gravity {0} m/s²: give a value between {1} and {2}.</source>
        <translation>Fallbeschleunigung {0} m/s²: eine zwischen {1} und {2} angeben.</translation>
    </message>
    <message>
        <source>gravity_W: gravity points up (by {0} N) against the declared direction of down. The sensor reports the opposite sign, or the orientations are inverted: correct that. If the robot is not mounted upright, give --down and recalibrate.</source>
        <translation>gravity_W: Die Schwerkraft zeigt nach oben (um {0} N), entgegen der angegebenen Richtung. Der Sensor meldet das umgekehrte Vorzeichen, oder die Orientierungen sind umgekehrt: Berichtigen Sie das. Falls der Roboter nicht aufrecht montiert ist, geben Sie --down an und kalibrieren Sie neu.</translation>
    </message>
    <message>
        <source>half a chunk</source>
        <translation>ein halber Chunk</translation>
    </message>
    <message>
        <source>half a message</source>
        <translation>eine halbe Nachricht</translation>
    </message>
    <message>
        <source>half a record</source>
        <translation>ein halber Datensatz</translation>
    </message>
    <message>
        <source>half into</source>
        <translation>Hälfte in</translation>
    </message>
    <message>
        <source>handle</source>
        <translation>Henkel</translation>
    </message>
    <message>
        <source>handles</source>
        <translation>Henkel</translation>
    </message>
    <message>
        <source>has a correlation beyond 1.</source>
        <translation>hat eine Korrelation über 1.</translation>
    </message>
    <message>
        <source>has a covariance where the variance is 0.</source>
        <translation>hat eine Kovarianz, wo die Varianz 0 ist.</translation>
    </message>
    <message>
        <source>has a negative eigenvalue.</source>
        <translation>hat einen negativen Eigenwert.</translation>
    </message>
    <message>
        <source>has the length {0}, not 1.</source>
        <translation>hat die Länge {0}, nicht 1.</translation>
    </message>
    <message>
        <source>has zero area</source>
        <translation>hat keine Fläche</translation>
    </message>
    <message>
        <source>has {0} bytes, more than {1}: it should hold {2}.</source>
        <translation>hat {0} Bytes, mehr als {1}; erwartet wird: {2}.</translation>
    </message>
    <message>
        <source>hold still</source>
        <translation>still halten</translation>
    </message>
    <message>
        <source>holds {0}, which is not a number: correct or remove the row.</source>
        <translation>enthält {0}, was keine Zahl ist: Berichtigen oder entfernen Sie die Zeile.</translation>
    </message>
    <message>
        <source>holds {0}: {1}</source>
        <translation>enthält {0}: {1}</translation>
    </message>
    <message>
        <source>hole</source>
        <translation>Loch</translation>
    </message>
    <message>
        <source>holes</source>
        <translation>Löcher</translation>
    </message>
    <message>
        <source>host {0}: a path needs three slashes: :///path</source>
        <translation>Host {0}: Ein Pfad braucht drei Schrägstriche: :///path</translation>
    </message>
    <message>
        <source>host: give a name or an IP address after ://</source>
        <translation>Host: Geben Sie nach :// einen Namen oder eine IP-Adresse an</translation>
    </message>
    <message>
        <source>host: {0}: write an IPv6 address as [::1]</source>
        <translation>Host: {0}: eine IPv6-Adresse als [::1] schreiben</translation>
    </message>
    <message>
        <source>how certain the calibration is</source>
        <translation>wie sicher die Kalibrierung ist</translation>
    </message>
    <message>
        <source>how old the bias is, and how fast it drifted</source>
        <translation>wie alt der Nullpunktfehler ist, und wie schnell er driftete</translation>
    </message>
    <message>
        <source>how the robot answers a touch</source>
        <translation>wie der Roboter auf eine Berührung antwortet</translation>
    </message>
    <message>
        <source>how the robot is mounted: where down is</source>
        <translation>wie der Roboter montiert ist: wo unten ist</translation>
    </message>
    <message>
        <source>how the sensor sits on the flange: every contact moves</source>
        <translation>wie der Sensor auf dem Flansch sitzt: Jeder Kontakt verschiebt sich</translation>
    </message>
    <message>
        <source>identical bytes.</source>
        <translation>identische Bytes.</translation>
    </message>
    <message>
        <source>identical to the original</source>
        <translation>identisch mit dem Original</translation>
    </message>
    <message>
        <source>if they are degrees, set the option angle of the address to deg</source>
        <translation>wenn es Grad sind, setzen Sie die Option angle der Adresse auf deg</translation>
    </message>
    <message>
        <source>import regions</source>
        <translation>Regionen importieren</translation>
    </message>
    <message>
        <source>imported from {0}{1}</source>
        <translation>importiert aus {0}{1}</translation>
    </message>
    <message>
        <source>in contact, with {0} N.</source>
        <translation>sie berührt, mit {0} N.</translation>
    </message>
    <message>
        <source>in line with the flange</source>
        <translation>mit dem Flansch ausgerichtet</translation>
    </message>
    <message>
        <source>inches</source>
        <translation>Zoll</translation>
    </message>
    <message>
        <source>inputs: {0} are needed{1}; {2} are given.</source>
        <translation>Eingaben: {0} werden gebraucht{1}; es sind {2}.</translation>
    </message>
    <message>
        <source>invented must be one 0 or 1 for each of the {0} facets, not {1} of shape {2}.</source>
        <translation>invented muss für jede der {0} Facetten eine 0 oder 1 sein, nicht {1} von der Form {2}.</translation>
    </message>
    <message>
        <source>invented: row {0} is {1}: use 1 for a facet that closes an opening, else 0.</source>
        <translation>invented: Zeile {0} ist {1}: 1 für eine Facette verwenden, die eine Öffnung schließt, sonst 0.</translation>
    </message>
    <message>
        <source>is &apos;passed&apos;, but nothing was located.</source>
        <translation>ist &apos;passed&apos;, aber nichts wurde geortet.</translation>
    </message>
    <message>
        <source>is 0, but verified is true.</source>
        <translation>ist 0, aber verified ist true.</translation>
    </message>
    <message>
        <source>is a link or device, not a file</source>
        <translation>ist ein Link oder ein Gerät, keine Datei</translation>
    </message>
    <message>
        <source>is compressed in an unusual way</source>
        <translation>ist auf ungewöhnliche Weise komprimiert</translation>
    </message>
    <message>
        <source>is encrypted</source>
        <translation>ist verschlüsselt</translation>
    </message>
    <message>
        <source>is impossibly far away</source>
        <translation>ist unmöglich weit weg</translation>
    </message>
    <message>
        <source>is missing</source>
        <translation>fehlt</translation>
    </message>
    <message>
        <source>is more than 60 degrees from world.down_W: check how the robot is mounted.</source>
        <translation>liegt mehr als 60 Grad neben world.down_W: Wie ist der Roboter montiert?</translation>
    </message>
    <message>
        <source>is more than verification.max_error_m.</source>
        <translation>ist größer als verification.max_error_m.</translation>
    </message>
    <message>
        <source>is no better</source>
        <translation>ist nicht besser</translation>
    </message>
    <message>
        <source>is not a finite number</source>
        <translation>ist keine endliche Zahl</translation>
    </message>
    <message>
        <source>is not a finite point</source>
        <translation>ist kein endlicher Punkt</translation>
    </message>
    <message>
        <source>is not a known field</source>
        <translation>ist kein bekanntes Feld</translation>
    </message>
    <message>
        <source>is not a time in UTC</source>
        <translation>ist keine Zeit in UTC</translation>
    </message>
    <message>
        <source>is not clearly better (p = {0})</source>
        <translation>ist nicht deutlich besser (p = {0})</translation>
    </message>
    <message>
        <source>is not symmetric, or has a variance below 0.</source>
        <translation>ist nicht symmetrisch oder hat eine Varianz unter 0.</translation>
    </message>
    <message>
        <source>is the file in {0}? Multiply by {1}{2}, or pass check_size=False if it is correct.</source>
        <translation>Ist die Datei in {0}? Multiplizieren Sie mit {1}{2}, oder geben Sie check_size=False an, wenn sie stimmt.</translation>
    </message>
    <message>
        <source>is too large</source>
        <translation>ist zu groß</translation>
    </message>
    <message>
        <source>is too small</source>
        <translation>ist zu klein</translation>
    </message>
    <message>
        <source>is true, but an error exceeds its limit.</source>
        <translation>ist true, aber ein Fehler überschreitet seine Grenze.</translation>
    </message>
    <message>
        <source>is true, but checks.{0} failed.</source>
        <translation>ist true, aber checks.{0} ist gescheitert.</translation>
    </message>
    <message>
        <source>is true, but provenance.stale says: {0}</source>
        <translation>ist true, aber provenance.stale sagt: {0}</translation>
    </message>
    <message>
        <source>is true, but the surface of the probe is open or inside out.</source>
        <translation>ist true, aber die Oberfläche der Sonde ist offen oder umgestülpt.</translation>
    </message>
    <message>
        <source>is true, but verification is missing or did not pass.</source>
        <translation>ist true, aber verification fehlt oder ist nicht bestanden.</translation>
    </message>
    <message>
        <source>is {0} kg, less than {1}: check whether forces were in kN.</source>
        <translation>ist {0} kg, weniger als {1}: Waren es kN?</translation>
    </message>
    <message>
        <source>is {0} kg, more than {1}: check whether it was given in grams.</source>
        <translation>ist {0} kg, mehr als {1}: Waren es Gramm?</translation>
    </message>
    <message>
        <source>is {0}, but the sensor was verified at sensor.rate_Hz, which is {1}.</source>
        <translation>ist {0}, aber der Sensor wurde mit sensor.rate_Hz überprüft, und das ist {1}.</translation>
    </message>
    <message>
        <source>is {0}, but {1} has {2}.</source>
        <translation>ist {0}, aber {1} hat {2}.</translation>
    </message>
    <message>
        <source>is {0}, more than {1} m: check whether it was mm.</source>
        <translation>ist {0}, mehr als {1} m: waren es mm?</translation>
    </message>
    <message>
        <source>is {0}, more than {1} {2}</source>
        <translation>ist {0}, mehr als {1} {2}</translation>
    </message>
    <message>
        <source>is {0}, more than {1}: check the unit.</source>
        <translation>ist {0}, mehr als {1}: stimmt die Einheit?</translation>
    </message>
    <message>
        <source>is {0}, not below half of {1} Hz.</source>
        <translation>ist {0}, nicht unter der Hälfte von {1} Hz.</translation>
    </message>
    <message>
        <source>is {0}, not below limits.max_force_N, which is {1}.</source>
        <translation>ist {0}, nicht unter limits.max_force_N mit dem Wert {1}.</translation>
    </message>
    <message>
        <source>is {0}, not {1}.</source>
        <translation>ist {0}, nicht {1}.</translation>
    </message>
    <message>
        <source>is {0}, too slow for {1} Hz.</source>
        <translation>ist {0}, zu langsam für {1} Hz.</translation>
    </message>
    <message>
        <source>is {0}: it must be above 0 and at most {1}.</source>
        <translation>ist {0}: muss über 0 und höchstens {1} sein.</translation>
    </message>
    <message>
        <source>is {0}: the sensor cannot measure limits.max_force_N, which is {1}.</source>
        <translation>ist {0}: Der Sensor kann limits.max_force_N nicht messen, und das ist {1}.</translation>
    </message>
    <message>
        <source>it cannot be imported: {0}</source>
        <translation>es lässt sich nicht importieren: {0}</translation>
    </message>
    <message>
        <source>it cannot be recomputed: {0}</source>
        <translation>es kann nicht noch einmal berechnet werden: {0}</translation>
    </message>
    <message>
        <source>it cannot be unpacked: {0}</source>
        <translation>es lässt sich nicht entpacken: {0}</translation>
    </message>
    <message>
        <source>it cannot retract farther.</source>
        <translation>sie kann nicht weiter zurück.</translation>
    </message>
    <message>
        <source>it contains a control character: type it again</source>
        <translation>sie enthält ein Steuerzeichen: neu eingeben</translation>
    </message>
    <message>
        <source>it has neither sensor nor poses</source>
        <translation>es hat weder sensor noch poses</translation>
    </message>
    <message>
        <source>it has no title</source>
        <translation>es hat keinen title</translation>
    </message>
    <message>
        <source>it has no ways: name the lines on which the device can be</source>
        <translation>es hat keine ways: Nennen Sie die Leitungen, an denen das Gerät hängen kann</translation>
    </message>
    <message>
        <source>it has turned by {0} degrees from the start, more than any tissue requires.</source>
        <translation>sie ist um {0} Grad gegenüber dem Beginn gedreht: Das verlangt kein Gewebe.</translation>
    </message>
    <message>
        <source>it is no pose</source>
        <translation>es ist keine Pose</translation>
    </message>
    <message>
        <source>it is not a subclass of contactbench.pipeline.devices.driver.Driver</source>
        <translation>es ist keine Unterklasse von contactbench.pipeline.devices.driver.Driver</translation>
    </message>
    <message>
        <source>it is packed as {0}, which is unknown</source>
        <translation>es ist als {0} gepackt, was unbekannt ist</translation>
    </message>
    <message>
        <source>it is {0} sigma from where the others put it</source>
        <translation>sie liegt {0} Sigma von dort entfernt, wo die anderen sie erwarten lassen</translation>
    </message>
    <message>
        <source>it ran out of memory</source>
        <translation>der Arbeitsspeicher ging aus</translation>
    </message>
    <message>
        <source>it was interrupted</source>
        <translation>es wurde unterbrochen</translation>
    </message>
    <message>
        <source>it was stopped.</source>
        <translation>sie wurde angehalten.</translation>
    </message>
    <message>
        <source>its checksum does not match</source>
        <translation>die Prüfsumme stimmt nicht</translation>
    </message>
    <message>
        <source>its emulated is not a subclass of Model</source>
        <translation>sein emulated ist keine Unterklasse von Model</translation>
    </message>
    <message>
        <source>its entry point is named otherwise than its scheme {0}</source>
        <translation>sein Entry-Point heißt anders als sein Schema {0}</translation>
    </message>
    <message>
        <source>its file {0}; compute it again</source>
        <translation>zu seiner Datei: {0}; berechnen Sie es erneut</translation>
    </message>
    <message>
        <source>its force pulls on the surface instead of pushing</source>
        <translation>ihre Kraft zieht an der Oberfläche, statt zu drücken</translation>
    </message>
    <message>
        <source>its header has no time: import without --header-stamps</source>
        <translation>ihr Header hat keine Zeit: Importieren Sie ohne --header-stamps</translation>
    </message>
    <message>
        <source>its length in metres</source>
        <translation>ihre Länge in Metern</translation>
    </message>
    <message>
        <source>its name must be one line of text of at most {0} bytes: change it.</source>
        <translation>der Name muss eine Textzeile von höchstens {0} Byte sein: Ändern Sie ihn.</translation>
    </message>
    <message>
        <source>its option {0} is not an Option with a name of its own</source>
        <translation>seine Option {0} ist keine Option mit eigenem Namen</translation>
    </message>
    <message>
        <source>its origin</source>
        <translation>woher es kommt</translation>
    </message>
    <message>
        <source>its priority regions</source>
        <translation>ihre Regionen mit Priorität</translation>
    </message>
    <message>
        <source>its scheme is {0}: give small letters and digits</source>
        <translation>sein Schema ist {0}: Nehmen Sie kleine Buchstaben und Ziffern</translation>
    </message>
    <message>
        <source>its serial way has no baud rate</source>
        <translation>sein serieller Weg hat keine Baudrate</translation>
    </message>
    <message>
        <source>its surface</source>
        <translation>ihre Oberfläche</translation>
    </message>
    <message>
        <source>its way {0} is none of serial, tcp, udp</source>
        <translation>sein Weg {0} ist keiner von serial, tcp, udp</translation>
    </message>
    <message>
        <source>its way {0} is not a Way</source>
        <translation>sein Weg {0} ist kein Way</translation>
    </message>
    <message>
        <source>its {0} way has no port</source>
        <translation>sein {0}-Weg hat keinen Port</translation>
    </message>
    <message>
        <source>joint limit</source>
        <translation>Gelenkgrenze</translation>
    </message>
    <message>
        <source>joint speed</source>
        <translation>Gelenkgeschwindigkeit</translation>
    </message>
    <message>
        <source>joint {0} to {1}°</source>
        <translation>Gelenk {0} auf {1}°</translation>
    </message>
    <message>
        <source>joints</source>
        <translation>Gelenke</translation>
    </message>
    <message>
        <source>joints are no list of angles</source>
        <translation>joints ist keine Liste von Winkeln</translation>
    </message>
    <message>
        <source>joints need a list of at most {0} angles</source>
        <translation>joints braucht eine Liste von höchstens {0} Winkeln</translation>
    </message>
    <message>
        <source>keep the force</source>
        <translation>die Kraft halten</translation>
    </message>
    <message>
        <source>known touch</source>
        <translation>bekannter Druckpunkt</translation>
    </message>
    <message>
        <source>known weight</source>
        <translation>bekanntes Gewicht</translation>
    </message>
    <message>
        <source>lag and noise of the contact point</source>
        <translation>Verzögerung und Rauschen des Kontaktpunkts</translation>
    </message>
    <message>
        <source>lag and noise of the wrench</source>
        <translation>Verzögerung und Rauschen von Kraft/Moment</translation>
    </message>
    <message>
        <source>largest contact error</source>
        <translation>größter Kontaktfehler</translation>
    </message>
    <message>
        <source>largest deviation</source>
        <translation>größte Abweichung</translation>
    </message>
    <message>
        <source>layout {0}: more than {1} bytes: choose another file</source>
        <translation>layout {0}: mehr als {1} Bytes: Wählen Sie eine andere Datei</translation>
    </message>
    <message>
        <source>layout {0}: there is no such file: give a TOML or JSON file</source>
        <translation>layout {0}: Diese Datei gibt es nicht: Geben Sie eine TOML- oder JSON-Datei an</translation>
    </message>
    <message>
        <source>layout {0}: unknown option {1}. Possible: {2}</source>
        <translation>layout {0}: unbekannte Option {1}. Möglich: {2}</translation>
    </message>
    <message>
        <source>layout {0}: {1} {2}: {3}</source>
        <translation>layout {0}: {1} {2}: {3}</translation>
    </message>
    <message>
        <source>layout {0}: {1}: give a TOML or JSON file</source>
        <translation>layout {0}: {1}: Geben Sie eine TOML- oder JSON-Datei an</translation>
    </message>
    <message>
        <source>least like the others</source>
        <translation>den anderen am wenigsten ähnlich</translation>
    </message>
    <message>
        <source>leave a torque that no single touch explains: press with a freely turning tip, and make sure nothing else touches the probe.</source>
        <translation>lassen ein Drehmoment übrig, das keine einzelne Berührung erklärt: mit einer frei drehbaren Spitze drücken, und nichts anderes darf die Sonde berühren.</translation>
    </message>
    <message>
        <source>leave out</source>
        <translation>weglassen</translation>
    </message>
    <message>
        <source>left open</source>
        <translation>offen gelassen</translation>
    </message>
    <message>
        <source>left out</source>
        <translation>ausgelassen</translation>
    </message>
    <message>
        <source>left out, {0} to {1} s: {2}</source>
        <translation>ausgelassen, {0} bis {1} s: {2}</translation>
    </message>
    <message>
        <source>less than {0} mm</source>
        <translation>weniger als {0} mm</translation>
    </message>
    <message>
        <source>limit {0} m, point {1} m: give lengths between 0 and 1 m.</source>
        <translation>Grenze {0} m, Punkt {1} m: Längen zwischen 0 und 1 m angeben.</translation>
    </message>
    <message>
        <source>limits {0}: give positive numbers.</source>
        <translation>Grenzen {0}: Geben Sie positive Zahlen an.</translation>
    </message>
    <message>
        <source>line of a closed loop: it cannot be read ({0}).</source>
        <translation>Zeile eines Regelkreises: Sie kann nicht gelesen werden ({0}).</translation>
    </message>
    <message>
        <source>line of a closed loop: its kind is {0}, not {1}, {2} or {3}.</source>
        <translation>Zeile eines Regelkreises: Ihre Art ist {0}, nicht {1}, {2} oder {3}.</translation>
    </message>
    <message>
        <source>line {0} of the OBJ text</source>
        <translation>Zeile {0} des OBJ-Texts</translation>
    </message>
    <message>
        <source>line {0} of the OBJ text is a facet without valid vertex numbers (counted from 1): repair that line or export the file again.</source>
        <translation>Zeile {0} des OBJ-Texts ist eine Facette ohne gültige Eckpunktnummern (gezählt ab 1): diese Zeile reparieren oder die Datei neu exportieren.</translation>
    </message>
    <message>
        <source>line {0} of the OBJ text is a vertex without three numbers: export the file again.</source>
        <translation>Zeile {0} des OBJ-Texts ist ein Eckpunkt ohne drei Zahlen: die Datei neu exportieren.</translation>
    </message>
    <message>
        <source>line {0} of the OFF text</source>
        <translation>Zeile {0} des OFF-Texts</translation>
    </message>
    <message>
        <source>line {0} of the OFF text is not {1}: it is damaged, export it again.</source>
        <translation>Zeile {0} des OFF-Texts ist nicht, was dort stehen muss ({1}): sie ist beschädigt, neu exportieren.</translation>
    </message>
    <message>
        <source>line {0} of the OFF text is one facet more than its header announces: the file is damaged, export it again.</source>
        <translation>Zeile {0} des OFF-Texts ist eine Facette mehr, als sein Kopf ankündigt: Die Datei ist beschädigt, neu exportieren.</translation>
    </message>
    <message>
        <source>line {0} of the PLY header, {1}, cannot be used: export the file again.</source>
        <translation>Zeile {0} des PLY-Kopfs, {1}, ist nicht zu gebrauchen: die Datei neu exportieren.</translation>
    </message>
    <message>
        <source>line {0} of the {1} text is a facet that refers to a vertex that does not exist (the file has {2}): it is damaged or cut short, export it again.</source>
        <translation>Zeile {0} des Texts ({1}) ist eine Facette mit einem Eckpunkt, den es nicht gibt (die Datei hat {2}): sie ist beschädigt oder abgeschnitten, neu exportieren.</translation>
    </message>
    <message>
        <source>line: {0}.</source>
        <translation>Leitung: {0}.</translation>
    </message>
    <message>
        <source>listed in provenance.files but missing</source>
        <translation>in provenance.files aufgeführt, fehlt aber</translation>
    </message>
    <message>
        <source>locked</source>
        <translation>gesperrt</translation>
    </message>
    <message>
        <source>m, in the sensor frame S</source>
        <translation>m, im Sensorsystem S</translation>
    </message>
    <message>
        <source>m: check whether they were mm.</source>
        <translation>m: Waren es mm?</translation>
    </message>
    <message>
        <source>margins: modulus {0} N/m³, unknown {1}: give a positive one, and -1 to 1.</source>
        <translation>Reserven: modulus {0} N/m³, unknown {1}: eine positive Zahl angeben, und -1 bis 1.</translation>
    </message>
    <message>
        <source>mark the touched region, and locate them again</source>
        <translation>markieren Sie die berührte Region, und bestimmen Sie die Kontakte neu</translation>
    </message>
    <message>
        <source>marked as stale</source>
        <translation>als veraltet markiert</translation>
    </message>
    <message>
        <source>marker name {0}: give 1 to {1} printable characters without spaces at the ends.</source>
        <translation>Markername {0}: Geben Sie 1 bis {1} druckbare Zeichen an, ohne Leerzeichen an den Enden.</translation>
    </message>
    <message>
        <source>marker {0} appears twice: give each marker its own name.</source>
        <translation>Marker {0} kommt zweimal vor: Geben Sie jedem einen eigenen Namen.</translation>
    </message>
    <message>
        <source>marker {0}: give three finite coordinates, not {1}.</source>
        <translation>Marker {0}: Geben Sie drei endliche Koordinaten an, nicht {1}.</translation>
    </message>
    <message>
        <source>marker {0}: the normal needs three numbers, not {1}.</source>
        <translation>Marker {0}: Die Normale braucht drei Zahlen, nicht {1}.</translation>
    </message>
    <message>
        <source>markers</source>
        <translation>Marker</translation>
    </message>
    <message>
        <source>markers in mm in the mesh&apos;s frame, forces in N and torques in N·m in the sensor frame S; nx,ny,nz (the outward normal) and marker (a name) may be added</source>
        <translation>Marker in mm im System des Netzes, Kräfte in N und Momente in N·m im Sensorsystem S; nx,ny,nz (die Normale nach außen) und marker (ein Name) können dazukommen</translation>
    </message>
    <message>
        <source>markers off the probe&apos;s surface: {0}{1}; {2} mm are allowed. Check that they are in millimetres in the sensor frame S, and belong to this probe.</source>
        <translation>Marker nicht auf der Oberfläche der Sonde: {0}{1}; erlaubt sind {2} mm. Prüfen Sie, ob es Millimeter im Sensorsystem S sind und ob sie zu dieser Sonde gehören.</translation>
    </message>
    <message>
        <source>markers {0} and {1} are {2} mm apart; {3} mm are needed to tell a wrong contact from a touch of the neighbour. Give the order of the touches, or skip markers</source>
        <translation>die Marker {0} und {1} liegen {2} mm auseinander; nötig sind {3} mm, um einen falschen Kontakt von einer Berührung des Nachbarn zu unterscheiden. Geben Sie die Reihenfolge der Berührungen an, oder lassen Sie Marker aus</translation>
    </message>
    <message>
        <source>markers: give points of shape (n, 3), not {0}.</source>
        <translation>Marker: Geben Sie Punkte der Form (n, 3) an, nicht {0}.</translation>
    </message>
    <message>
        <source>markers: no part of the probe faces +z near its tip: check that it is aligned.</source>
        <translation>Marker: Kein Teil der Sonde zeigt nahe der Spitze nach +z: Ist sie ausgerichtet?</translation>
    </message>
    <message>
        <source>markers: the probe has no sides that a tip can reach: check that it is aligned.</source>
        <translation>Marker: Die Sonde hat keine Seiten, die eine Spitze erreicht: Ist sie ausgerichtet?</translation>
    </message>
    <message>
        <source>markers: {0} names for {1} points: give one for each.</source>
        <translation>Marker: {0} Namen für {1} Punkte: Geben Sie für jeden einen an.</translation>
    </message>
    <message>
        <source>mass {0} ± {1} kg: give a mass above 0 and a smaller uncertainty.</source>
        <translation>Masse {0} ± {1} kg: eine Masse über 0 angeben und eine kleinere Unsicherheit.</translation>
    </message>
    <message>
        <source>mean error</source>
        <translation>mittlerer Fehler</translation>
    </message>
    <message>
        <source>mean force</source>
        <translation>mittlere Kraft</translation>
    </message>
    <message>
        <source>mean readings with bias and weight, forces in N, torques in N·m, in the sensor frame S</source>
        <translation>mittlere Messwerte mit Nullpunktfehler und Gewicht, Kräfte in N, Momente in N·m, im Sensorsystem S</translation>
    </message>
    <message>
        <source>measuring</source>
        <translation>misst</translation>
    </message>
    <message>
        <source>method {0} cannot track: only contactbench can. Choose it, or do not track.</source>
        <translation>Verfahren {0} kann nicht verfolgen: Nur contactbench kann es. Wählen Sie es, oder verzichten Sie auf das Verfolgen.</translation>
    </message>
    <message>
        <source>metres</source>
        <translation>Meter</translation>
    </message>
    <message>
        <source>micrometres</source>
        <translation>Mikrometer</translation>
    </message>
    <message>
        <source>millimetres</source>
        <translation>Millimeter</translation>
    </message>
    <message>
        <source>misses the probe</source>
        <translation>verfehlt die Sonde</translation>
    </message>
    <message>
        <source>missing</source>
        <translation>fehlt</translation>
    </message>
    <message>
        <source>mm, in the sensor frame S</source>
        <translation>mm, im Sensorsystem S</translation>
    </message>
    <message>
        <source>mm: distance of the acoustic face outside its mesh.</source>
        <translation>mm: So weit liegt die Schallfläche außerhalb ihres Netzes.</translation>
    </message>
    <message>
        <source>mm: position error of marked points, root mean square in each direction along the surface.</source>
        <translation>mm: So weit liegen Markierungen daneben, quadratisches Mittel je Richtung längs der Oberfläche.</translation>
    </message>
    <message>
        <source>mm: radius of a soft pad that presses in place of the tip.</source>
        <translation>mm: Radius eines weichen Kissens, das anstelle der Spitze drückt.</translation>
    </message>
    <message>
        <source>mm: radius of the ball aimed at a mark; a tilted one touches beside it by this times sin(tilt).</source>
        <translation>mm: Radius der Kugel, mit der auf eine Marke gezielt wird; eine geneigte berührt um das mal sin(Neigung) daneben.</translation>
    </message>
    <message>
        <source>model and serial number missing</source>
        <translation>Modell und Seriennummer fehlen</translation>
    </message>
    <message>
        <source>more than half of the shell would be invented: the mesh is a sheet without thickness, or a small part of a probe. Export the whole part as a solid.</source>
        <translation>mehr als die Hälfte der Außenfläche wäre erfunden: Das Netz ist ein Blatt ohne Dicke oder ein kleiner Teil einer Sonde. Exportieren Sie das ganze Teil als Volumenkörper.</translation>
    </message>
    <message>
        <source>more than the requested {0}, because no smaller number tried gave a valid surface</source>
        <translation>mehr als die verlangten {0}, weil keine kleinere Zahl, die versucht wurde, eine brauchbare Oberfläche ergab</translation>
    </message>
    <message>
        <source>more than {0} mm</source>
        <translation>mehr als {0} mm</translation>
    </message>
    <message>
        <source>more than {0} rows of {1}: choose the right file or shorten it.</source>
        <translation>mehr als {0} Zeilen ({1}): Wählen Sie die richtige Datei, oder kürzen Sie sie.</translation>
    </message>
    <message>
        <source>more than {0} times its packed size</source>
        <translation>mehr als das {0}-Fache der gepackten Größe</translation>
    </message>
    <message>
        <source>most</source>
        <translation>den größten Teil</translation>
    </message>
    <message>
        <source>mount has shape {0}: give a 4 x 4 transform T_SP.</source>
        <translation>mount hat die Form {0}: eine 4 x 4-Transformation T_SP angeben.</translation>
    </message>
    <message>
        <source>mount has the last row {0}, not [0, 0, 0, 1]: is it transposed?</source>
        <translation>mount hat die letzte Zeile {0}, nicht [0, 0, 0, 1]: Ist es transponiert?</translation>
    </message>
    <message>
        <source>mount holds NaN or infinity: give a finite 4 x 4 transform T_SP.</source>
        <translation>mount enthält NaN oder unendlich: eine endliche 4 x 4-Transformation T_SP angeben.</translation>
    </message>
    <message>
        <source>mount is not a matrix of numbers ({0}): give a 4 x 4 transform T_SP.</source>
        <translation>mount ist keine Matrix aus Zahlen ({0}): eine 4 x 4-Transformation T_SP angeben.</translation>
    </message>
    <message>
        <source>mount mirrors the mesh (determinant -1): one axis has the wrong sign.</source>
        <translation>mount spiegelt das Netz (Determinante -1): Eine Achse hat das falsche Vorzeichen.</translation>
    </message>
    <message>
        <source>mount moves the mesh by {0} m: give the translation in metres.</source>
        <translation>mount verschiebt das Netz um {0} m: die Verschiebung in Metern angeben.</translation>
    </message>
    <message>
        <source>mount scales or shears: its 3 x 3 part is not a rotation within 1e-6. Convert lengths with units, and give rotations with at least seven digits.</source>
        <translation>mount skaliert oder schert: Sein 3 x 3-Teil ist auf 1e-6 genau keine Drehung. Längen mit units umrechnen und Drehungen mit mindestens sieben Stellen angeben.</translation>
    </message>
    <message>
        <source>mount: R_ES must be a rotation (3, 3), p_ES_E three finite numbers (m): take both from the drawing of the adapter between flange and sensor.</source>
        <translation>Montage: R_ES muss eine Drehung (3, 3) sein, p_ES_E drei endliche Zahlen (m): beide der Zeichnung des Adapters zwischen Flansch und Sensor entnehmen.</translation>
    </message>
    <message>
        <source>mounts: the shape is {0}: give one T_SP (4, 4), or several (k, 4, 4).</source>
        <translation>mounts: Die Form ist {0}: Geben Sie ein T_SP (4, 4) an, oder mehrere (k, 4, 4).</translation>
    </message>
    <message>
        <source>mounts: these are not numbers ({0}): give T_SP (4, 4).</source>
        <translation>mounts: Das sind keine Zahlen ({0}): Geben Sie T_SP (4, 4) an.</translation>
    </message>
    <message>
        <source>moved on without release</source>
        <translation>ohne Loslassen weiterbewegt</translation>
    </message>
    <message>
        <source>mrad/N·m: rotation of the probe against its sensor under a torque.</source>
        <translation>mrad/N·m: So weit dreht sich die Sonde unter einem Moment gegen ihren Sensor.</translation>
    </message>
    <message>
        <source>ms: additional random delay, on average.</source>
        <translation>ms: zusätzlicher zufälliger Verzug, im Mittel.</translation>
    </message>
    <message>
        <source>ms: age of poses at their stated time.</source>
        <translation>ms: Alter der Posen zu ihrer angegebenen Zeit.</translation>
    </message>
    <message>
        <source>ms: delay of the wrenches.</source>
        <translation>ms: Verzug der Messwerte.</translation>
    </message>
    <message>
        <source>multiple of the pace of the file</source>
        <translation>Vielfaches des Tempos der Datei</translation>
    </message>
    <message>
        <source>multiple of the recorded pace, or step</source>
        <translation>Vielfaches des aufgezeichneten Tempos, oder step</translation>
    </message>
    <message>
        <source>must begin with a small letter and contain only small letters, digits, - and _, at most 64</source>
        <translation>muss mit einem Kleinbuchstaben beginnen und darf nur Kleinbuchstaben, Ziffern, - und _ enthalten, höchstens 64</translation>
    </message>
    <message>
        <source>must have 1 to 200 characters, no control characters and none of / \\ : * ? &quot; &lt; &gt; |, and must not begin with a dot</source>
        <translation>muss 1 bis 200 Zeichen haben, darf keine Steuerzeichen und keines von / \\ : * ? &quot; &lt; &gt; | enthalten und nicht mit einem Punkt beginnen</translation>
    </message>
    <message>
        <source>name a folder of your own in {0}</source>
        <translation>in {0} einen eigenen Ordner nennen</translation>
    </message>
    <message>
        <source>nearer to the point picked</source>
        <translation>näher am gewählten Punkt</translation>
    </message>
    <message>
        <source>nearly all</source>
        <translation>fast alles</translation>
    </message>
    <message>
        <source>newton metres</source>
        <translation>Newtonmeter</translation>
    </message>
    <message>
        <source>newtons</source>
        <translation>Newton</translation>
    </message>
    <message>
        <source>next</source>
        <translation>nächste</translation>
    </message>
    <message>
        <source>no JSON ({0})</source>
        <translation>kein JSON ({0})</translation>
    </message>
    <message>
        <source>no JSON object</source>
        <translation>kein JSON-Objekt</translation>
    </message>
    <message>
        <source>no candidate can be reached from here by a straight joint move: first move the robot to a clearer position</source>
        <translation>keine der möglichen Posen lässt sich von hier mit einer geraden Gelenkbewegung erreichen: Bewegen Sie den Roboter zuerst an eine freiere Stelle</translation>
    </message>
    <message>
        <source>no complete answer within {0} s</source>
        <translation>keine vollständige Antwort innerhalb von {0} s</translation>
    </message>
    <message>
        <source>no connection ({0})</source>
        <translation>keine Verbindung ({0})</translation>
    </message>
    <message>
        <source>no count</source>
        <translation>keine Anzahl</translation>
    </message>
    <message>
        <source>no description</source>
        <translation>keine Beschreibung</translation>
    </message>
    <message>
        <source>no drift shows in what is left</source>
        <translation>im Rest zeigt sich keine Drift</translation>
    </message>
    <message>
        <source>no event</source>
        <translation>kein Ereignis</translation>
    </message>
    <message>
        <source>no kind of device: {0}</source>
        <translation>keine Art von Gerät: {0}</translation>
    </message>
    <message>
        <source>no list of {0} numbers</source>
        <translation>keine Liste von {0} Zahlen</translation>
    </message>
    <message>
        <source>no messages</source>
        <translation>keine Nachrichten</translation>
    </message>
    <message>
        <source>no noise</source>
        <translation>kein Rauschen</translation>
    </message>
    <message>
        <source>not counted</source>
        <translation>nicht gezählt</translation>
    </message>
    <message>
        <source>not good enough to use</source>
        <translation>nicht gut genug</translation>
    </message>
    <message>
        <source>not passed</source>
        <translation>nicht bestanden</translation>
    </message>
    <message>
        <source>not started</source>
        <translation>nicht begonnen</translation>
    </message>
    <message>
        <source>nothing can be read from it any more</source>
        <translation>davon lässt sich nichts mehr lesen</translation>
    </message>
    <message>
        <source>processor: {0} of a core at {1} samples per second; with these outputs about {2} would fit.</source>
        <translation>Prozessor: {0} eines Kerns bei {1} Messwerten je Sekunde; mit diesen Ausgaben wären etwa {2} möglich.</translation>
    </message>
    <message>
        <source>ready</source>
        <translation>bereit</translation>
    </message>
    <message>
        <source>ready: touch</source>
        <translation>bereit: berühren</translation>
    </message>
    <message>
        <source>robot kinematics</source>
        <translation>Roboterkinematik</translation>
    </message>
    <message>
        <source>run `contactbench calibrate diagnose`</source>
        <translation>führen Sie `contactbench calibrate diagnose` aus</translation>
    </message>
    <message>
        <source>run `contactbench probe align`</source>
        <translation>führen Sie `contactbench probe align` aus</translation>
    </message>
    <message>
        <source>run `contactbench session repair`</source>
        <translation>führen Sie `contactbench session repair` aus</translation>
    </message>
    <message>
        <source>run `contactbench session repair` to set this record aside</source>
        <translation>führen Sie `contactbench session repair` aus, um diesen Eintrag beiseitezulegen</translation>
    </message>
    <message>
        <source>run `contactbench session salvage` to copy everything intact, or restore a backup</source>
        <translation>führen Sie `contactbench session salvage` aus, um alles Heile zu kopieren, oder spielen Sie eine Sicherung ein</translation>
    </message>
    <message>
        <source>running</source>
        <translation>läuft</translation>
    </message>
    <message>
        <source>stale</source>
        <translation>veraltet</translation>
    </message>
    <message>
        <source>swinging: the force alternates around what is wanted; nothing is led.</source>
        <translation>schwingt: Die Kraft pendelt um den Sollwert; es wird nichts mehr vorausgeführt.</translation>
    </message>
    <message>
        <source>the STEP file gave no usable surface: {0} {1}</source>
        <translation>die STEP-Datei ergab keine brauchbare Fläche: {0} {1}</translation>
    </message>
    <message>
        <source>the cut facets are no mesh ({0}): export them again.</source>
        <translation>Die geschnittenen Facetten sind kein Netz ({0}): Exportieren Sie sie noch einmal.</translation>
    </message>
    <message>
        <source>the cut facets cannot be read ({0}): export them again.</source>
        <translation>Die geschnittenen Facetten lassen sich nicht lesen ({0}): Exportieren Sie sie noch einmal.</translation>
    </message>
    <message>
        <source>the cut facets cannot be read: export them again.</source>
        <translation>Die geschnittenen Facetten lassen sich nicht lesen: Exportieren Sie sie noch einmal.</translation>
    </message>
    <message>
        <source>the diagnostics cannot be written</source>
        <translation>Die Diagnose kann nicht geschrieben werden</translation>
    </message>
    <message>
        <source>the facets were cut on another mesh: paint the regions again.</source>
        <translation>Die Facetten wurden auf einem anderen Netz geschnitten: Malen Sie die Regionen neu.</translation>
    </message>
    <message>
        <source>the force is back in its band.</source>
        <translation>Die Kraft ist zurück in ihrem Band.</translation>
    </message>
    <message>
        <source>the full mesh settles only {0} of {1} touches ({2}), so there is nothing to compare with: check that the surface is a closed shell in the sensor&apos;s frame, without openings into a hollow (--close auto), and that the forces are the expected ones.</source>
        <translation>das volle Netz ortet nur {0} von {1} Berührungen eindeutig ({2}), deshalb gibt es nichts, womit verglichen werden kann: Prüfen Sie, ob die Oberfläche eine geschlossene Außenfläche im Sensorsystem ist, ohne Öffnungen in einen Hohlraum (--close auto), und ob die Kräfte die erwarteten sind.</translation>
    </message>
    <message>
        <source>the heatmap cannot be written</source>
        <translation>Die Heatmap kann nicht geschrieben werden</translation>
    </message>
    <message>
        <source>the markers cannot be written</source>
        <translation>Die Marker können nicht geschrieben werden</translation>
    </message>
    <message>
        <source>the probe cannot be written</source>
        <translation>Die Sonde kann nicht geschrieben werden</translation>
    </message>
    <message>
        <source>the probe was never aligned with the sensor: {0}</source>
        <translation>die Sonde wurde nie am Sensor ausgerichtet: {0}</translation>
    </message>
    <message>
        <source>the region {0} is not what was painted: of {1} cm², {2} cm² ({3} %) are missing, and {4} cm² ({5} %) were added. Keep more facets, or paint it again.</source>
        <translation>die Region {0} ist nicht das, was gemalt wurde: Von {1} cm² fehlen {2} cm² ({3} %), und {4} cm² ({5} %) kamen hinzu. Behalten Sie mehr Facetten, oder malen Sie sie neu.</translation>
    </message>
    <message>
        <source>the regions cannot be written</source>
        <translation>Die Regionen können nicht geschrieben werden</translation>
    </message>
    <message>
        <source>the suffix {0} is not one of {1}, and the content is none of these formats: export the part as one of them.</source>
        <translation>Die Endung {0} ist keine von {1}, und auch der Inhalt hat keines dieser Formate: Exportieren Sie das Teil in einem davon.</translation>
    </message>
    <message>
        <source>the work was cancelled: the mesh is unchanged.</source>
        <translation>Die Arbeit wurde abgebrochen: Das Netz ist unverändert.</translation>
    </message>
    <message>
        <source>the {0} file holds no facets: export the part again, as a surface.</source>
        <translation>Die {0}-Datei enthält keine Facetten: Exportieren Sie das Teil erneut, als Oberfläche.</translation>
    </message>
    <message>
        <source>this is a Git LFS pointer; the mesh itself was not downloaded. Run &apos;git lfs pull&apos; in its repository.</source>
        <translation>Dies ist ein Git-LFS-Zeiger; das Netz selbst wurde nicht heruntergeladen. Führen Sie in seinem Repository &apos;git lfs pull&apos; aus.</translation>
    </message>
    <message>
        <source>this is a STEP file, but it is cut short or damaged (it does not end with {0}): copy or export it again.</source>
        <translation>das ist eine STEP-Datei, aber sie ist abgeschnitten oder beschädigt (sie endet nicht mit {0}): neu kopieren oder exportieren.</translation>
    </message>
    <message>
        <source>this is a STEP file, but several of its entities have the same number, so it is damaged: copy or export it again.</source>
        <translation>das ist eine STEP-Datei, aber mehrere ihrer Einträge haben dieselbe Nummer; sie ist also beschädigt: neu kopieren oder exportieren.</translation>
    </message>
    <message>
        <source>this is a VTK file, but it announces {0} numbers, more than its {1} bytes can hold: it is cut short or damaged. {2}</source>
        <translation>das ist eine VTK-Datei, aber sie kündigt {0} Zahlen an, mehr als in ihre {1} Bytes passen: Sie ist abgeschnitten oder beschädigt. {2}</translation>
    </message>
    <message>
        <source>this is a probe that contactbench wrote: unpack it, and end its name in .ply.</source>
        <translation>Dies ist eine von contactbench geschriebene Sonde: Entpacken Sie sie und lassen Sie ihren Namen auf .ply enden.</translation>
    </message>
    <message>
        <source>this is a web page, not a mesh. Download the file itself (&apos;Raw&apos; or &apos;Download&apos; on the page).</source>
        <translation>Dies ist eine Webseite, kein Netz. Laden Sie die Datei selbst herunter (&apos;Raw&apos; oder &apos;Download&apos; auf der Seite).</translation>
    </message>
    <message>
        <source>this is an IGES file: it contains the curved surfaces of a CAD program but no triangles. Open it in a CAD program and export the part as STEP or 3MF, or as STL in millimetres, with a tolerance of 0.01 mm.</source>
        <translation>Dies ist eine IGES-Datei: Sie enthält gekrümmte Flächen eines CAD-Programms, aber keine Dreiecke. Öffnen Sie sie in einem CAD-Programm und exportieren Sie das Teil als STEP oder 3MF oder als STL in Millimetern, mit einer Toleranz von 0,01 mm.</translation>
    </message>
    <message>
        <source>usable</source>
        <translation>brauchbar</translation>
    </message>
    <message>
        <source>written by a newer contactbench (version above {0}): update contactbench.</source>
        <translation>von einem neueren contactbench geschrieben (Version über {0}): Aktualisieren Sie contactbench.</translation>
    </message>
    <message>
        <source>{0} % of the surface is a sheet without thickness, which has no inside. Export the whole part as a solid, or delete the sheet in the CAD program.</source>
        <translation>{0} % der Fläche ist ein Blatt ohne Dicke, das kein Inneres hat. Exportieren Sie das ganze Teil als Volumenkörper, oder löschen Sie das Blatt im CAD-Programm.</translation>
    </message>
    <message>
        <source>{0} cm² mirrored; every facet has a counterpart.</source>
        <translation>{0} cm² gespiegelt; jede Facette hat ein Gegenstück.</translation>
    </message>
    <message>
        <source>{0} cm² mirrored; {1} facets have no counterpart within {2} mm: the surface is not symmetric there.</source>
        <translation>{0} cm² gespiegelt; {1} Facetten haben kein Gegenstück innerhalb von {2} mm: Die Oberfläche ist dort nicht symmetrisch.</translation>
    </message>
    <message>
        <source>{0} needs MuJoCo, which cannot be imported ({1}): pip install &apos;contactbench[sim]&apos;</source>
        <translation>{0} braucht MuJoCo, das nicht importiert werden kann ({1}): pip install &apos;contactbench[sim]&apos;</translation>
    </message>
    <message>
        <source>{0} numbers</source>
        <translation>{0} Zahlen</translation>
    </message>
    <message>
        <source>{0} refused &apos;{1}&apos;: {2}.{3}</source>
        <translation>{0} hat &apos;{1}&apos; abgelehnt: {2}.{3}</translation>
    </message>
    <message>
        <source>{0} rows left out: column {1} is empty or no number, first in line {2}.</source>
        <translation>{0} Zeilen ausgelassen: Spalte {1} ist leer oder keine Zahl, zuerst in Zeile {2}.</translation>
    </message>
    <message>
        <source>{0} took longer than {1} s for &apos;{2}&apos; and was stopped.{3}</source>
        <translation>{0} brauchte länger als {1} s für „{2}“ und wurde angehalten.{3}</translation>
    </message>
    <message>
        <source>{0} {1} on &apos;{2}&apos;{3}; nothing else was affected.{4}{5}{6}</source>
        <translation>{0} {1} bei &apos;{2}&apos;{3}; sonst ist nichts betroffen.{4}{5}{6}</translation>
    </message>
    <message>
        <source>{0}, port {1}</source>
        <translation>{0}, Port {1}</translation>
    </message>
    <message>
        <source>{0}: a recording in progress, or one that ended abruptly: {1} to recover the latter.</source>
        <translation>{0}: Eine laufende oder plötzlich beendete Aufzeichnung: {1}, um eine beendete zu retten.</translation>
    </message>
    <message>
        <source>{0}: a recording with this name ended abruptly: {1} to recover it, or choose another name.</source>
        <translation>{0}: Eine Aufzeichnung dieses Namens endete plötzlich: {1}, um sie zu retten, oder wählen Sie einen anderen Namen.</translation>
    </message>
    <message>
        <source>{0}: it cannot be read ({1}): choose a YAML file.</source>
        <translation>{0}: Die Datei kann nicht gelesen werden ({1}): eine YAML-Datei wählen.</translation>
    </message>
    <message>
        <source>{0}: it cannot be written ({1}): choose a new folder.</source>
        <translation>{0}: kann nicht geschrieben werden ({1}): einen neuen Ordner wählen.</translation>
    </message>
    <message>
        <source>{0}: it contains {1} sensors and {2} robots: record one of each, the robot with --pose, or convert the right ones to CSV.</source>
        <translation>{0}: Sie enthält {1} Sensoren und {2} Roboter: je einen aufzeichnen, den Roboter mit --pose, oder die richtigen in CSV umwandeln.</translation>
    </message>
    <message>
        <source>{0}: mass and offsets are zero, as before a calibration: {1}</source>
        <translation>{0}: Masse und Offsets sind null, wie vor einer Kalibrierung: {1}</translation>
    </message>
    <message>
        <source>{0}: migrated from version {1} to {2}; results are as they were, and `session replay` tells how far contacts move. The previous journal is kept as {3}.</source>
        <translation>{0}: Von Version {1} auf {2} migriert; die Ergebnisse sind unverändert, und `session replay` sagt, wie weit sich Kontakte verschieben. Das bisherige Journal bleibt als {3} erhalten.</translation>
    </message>
    <message>
        <source>{0}: neither mass nor gripper_mass is there: choose the calibration file of ft_tools_ros2 or force_torque_tools.</source>
        <translation>{0}: Weder mass noch gripper_mass ist vorhanden: die Kalibrierdatei von ft_tools_ros2 oder force_torque_tools wählen.</translation>
    </message>
    <message>
        <source>{0}: not fit for contacts, so nothing was written: {1}</source>
        <translation>{0}: für Kontakte nicht geeignet, daher wurde nichts geschrieben: {1}</translation>
    </message>
    <message>
        <source>{0}: the file cannot be added to the session ({1}): free disk space or check the disk, then {2}. Nothing is lost.</source>
        <translation>{0}: Die Datei kann nicht in die Sitzung übernommen werden ({1}): Schaffen Sie Platz oder prüfen Sie den Datenträger, danach {2}. Nichts ist verloren.</translation>
    </message>
    <message>
        <source>{0}: the mass is negative: the tool calibrated with gravity upside down. {1}</source>
        <translation>{0}: Die Masse ist negativ: Das Werkzeug wurde mit umgekehrter Schwerkraft kalibriert. {1}</translation>
    </message>
    <message>
        <source>{0}: the verification cannot be read ({1}): verify again.</source>
        <translation>{0}: Die Überprüfung kann nicht gelesen werden ({1}): Überprüfen Sie erneut.</translation>
    </message>
    <message>
        <source>{0}: this folder is not a session: check the path, or create a new one.</source>
        <translation>{0}: Dieser Ordner ist keine Sitzung: Prüfen Sie den Pfad, oder legen Sie eine neue an.</translation>
    </message>
    <message>
        <source>{0}: this recording ended abruptly and would be left out: {1} to recover it, then pack again.</source>
        <translation>{0}: Diese Aufzeichnung endete plötzlich und würde fehlen: {1}, um sie zu retten, und packen Sie dann noch einmal.</translation>
    </message>
    <message>
        <source>{0}: this recording ended abruptly: {1} to recover it.</source>
        <translation>{0}: Diese Aufzeichnung endete plötzlich: {1}, um sie zu retten.</translation>
    </message>
    <message>
        <source>{0}: {1} is missing: {2}</source>
        <translation>{0}: {1} fehlt: {2}</translation>
    </message>
    <message>
        <source>{0}: {1} is not {2} of a plausible size: {3}</source>
        <translation>{0}: {1} ist nicht {2} von plausibler Größe: {3}</translation>
    </message>
    <message>
        <source>{0}: {1} is there twice: {2}</source>
        <translation>{0}: {1} kommt zweimal vor: {2}</translation>
    </message>
    <message>
        <source>{0}: {1}: it was never confirmed and {2}.</source>
        <translation>{0}: {1}: er wurde nie bestätigt und {2}.</translation>
    </message>
    <message>
        <source>{0}; expected {1}: choose {2}.</source>
        <translation>{0}; erwartet wird {1}: Wählen Sie {2}.</translation>
    </message>
    <message>
        <source>no priority regions</source>
        <translation>keine Region mit Priorität</translation>
    </message>
    <message>
        <source> Contacts moved by up to {0} mm.</source>
        <translation> Kontakte haben sich um bis zu {0} mm verschoben.</translation>
    </message>
    <message>
        <source> It finds {0} touches, and found {1}.</source>
        <translation> Es findet {0} Berührungen, vorher waren es {1}.</translation>
    </message>
    <message>
        <source>A filter is for {0} Hz, but the config is for {1}.</source>
        <translation>Ein Filter ist für {0} Hz gemacht, die Konfiguration für {1}.</translation>
    </message>
    <message>
        <source>Behind the config&apos;s filter wrenches scatter {0} times as much as was verified: filter the wrench more.</source>
        <translation>Hinter dem Filter der Konfiguration streuen Kräfte und Momente {0}-mal so stark wie geprüft: stärker filtern.</translation>
    </message>
    <message>
        <source>Bundles before version 3 were verified with other rules, which are gone: verify and export again.</source>
        <translation>Pakete vor Version 3 wurden nach anderen Regeln geprüft, die es nicht mehr gibt: erneut prüfen und exportieren.</translation>
    </message>
    <message>
        <source>Each reading holds {0} % of the pose before: the sensor filters and has not settled, or a cable or hose drags</source>
        <translation>Jeder Messwert enthält {0} % der vorigen Pose: Der Sensor filtert und ist noch nicht eingeschwungen, oder ein Kabel oder Schlauch schleppt nach</translation>
    </message>
    <message>
        <source>Forces are in {0}</source>
        <translation>Kräfte sind in {0}</translation>
    </message>
    <message>
        <source>Forces are in {0} and torques in {1}</source>
        <translation>Kräfte sind in {0} und Momente in {1}</translation>
    </message>
    <message>
        <source>Only one of config and verification lets the zero follow: verify and export with the same choice.</source>
        <translation>Nur in der Konfiguration oder nur in der Überprüfung wird der Nullpunkt nachgeführt: gleich prüfen und exportieren.</translation>
    </message>
    <message>
        <source>Other units are not excluded, with a probability of {0} %: {1} would fit as well, with a tool of {2} kg instead of {3} kg. Weigh it, or give the noise from the sensor&apos;s data sheet.</source>
        <translation>Andere Einheiten sind nicht ausgeschlossen, mit einer Wahrscheinlichkeit von {0} %: {1} passt ebenso gut, mit einem Werkzeug von {2} kg statt {3} kg. Wiegen Sie es, oder geben Sie das Rauschen aus dem Datenblatt des Sensors an.</translation>
    </message>
    <message>
        <source>Publish contacts in this DDS domain, and wrenches that ROS 2 takes.</source>
        <translation>Kontakte in dieser DDS-Domäne veröffentlichen, dazu Kräfte und Momente für ROS 2.</translation>
    </message>
    <message>
        <source>The config states {0} of the noise that the verification found, so more contacts are sure than were verified: leave the noise out.</source>
        <translation>Die Konfiguration nennt nur das {0}-Fache des Rauschens aus der Überprüfung, deshalb gelten mehr Kontakte als sicher als geprüft: das Rauschen weglassen.</translation>
    </message>
    <message>
        <source>The config&apos;s filters let contacts lag by {0} ms, and verified touches stood still: export with the adaptive filter and a higher cutoff.</source>
        <translation>Durch die Filter der Konfiguration kommen Kontakte {0} ms verspätet, und die geprüften Berührungen standen still: mit dem adaptiven Filter und höherer Grenzfrequenz exportieren.</translation>
    </message>
    <message>
        <source>The points fit only mirrored (within {0} mm rms, else {1} mm): one of the frames is left-handed, or two points are swapped. Check the signs of the axes and the order.</source>
        <translation>Die Punkte passen nur gespiegelt (bis auf {0} mm rms, sonst {1} mm): Eines der Koordinatensysteme ist linkshändig, oder zwei Punkte sind vertauscht. Prüfen Sie die Vorzeichen der Achsen und die Reihenfolge.</translation>
    </message>
    <message>
        <source>The points lie in one plane, so a mirrored frame would not show: add a point well off it.</source>
        <translation>Die Punkte liegen in einer Ebene, sodass ein gespiegeltes Koordinatensystem nicht auffiele: Fügen Sie einen Punkt deutlich außerhalb hinzu.</translation>
    </message>
    <message>
        <source>The poses disagree far more than the readings scatter within each of them. Either the orientations follow another convention than declared ({0}), or captures were disturbed.</source>
        <translation>Die Posen widersprechen sich weit mehr, als die Messwerte innerhalb jeder Pose streuen. Entweder folgen die Orientierungen einer anderen Konvention als angegeben ({0}), oder Aufnahmen wurden gestört.</translation>
    </message>
    <message>
        <source>The residuals are {0} times what the specified noise explains. Check the convention of the orientations ({1}), and that nothing touched the tool.</source>
        <translation>Die Restabweichungen sind das {0}-Fache dessen, was das angegebene Rauschen erklärt. Prüfen Sie die Konvention der Orientierungen ({1}), und ob nichts das Werkzeug berührt hat.</translation>
    </message>
    <message>
        <source>The tip is the end {0}; x points towards +x of the mesh&apos;s frame, or +y or +z where that is across. Three other rotations have the same axes.</source>
        <translation>Die Spitze ist das Ende {0}; x zeigt in Richtung +x des Netz-Koordinatensystems, oder +y oder +z, wo dies quer liegt. Drei andere Drehungen haben dieselben Achsen.</translation>
    </message>
    <message>
        <source>Three points check one another only by their distances: a fourth, off their plane, would reveal a wrong one or a mirrored frame.</source>
        <translation>Drei Punkte prüfen einander nur über ihre Abstände: Ein vierter außerhalb ihrer Ebene würde einen falschen oder ein gespiegeltes Koordinatensystem aufdecken.</translation>
    </message>
    <message>
        <source>Torques are in {0}</source>
        <translation>Momente sind in {0}</translation>
    </message>
    <message>
        <source>Turned by 180° about {0}, the surface lies within {1} mm of itself, so its shape cannot tell the two apart: fix the turn by a point or by touches.</source>
        <translation>Um 180° um {0} gedreht liegt die Oberfläche bis auf {1} mm auf sich selbst, ihre Form kann die beiden Lagen also nicht unterscheiden: Legen Sie die Drehung durch einen Punkt oder durch Berührungen fest.</translation>
    </message>
    <message>
        <source>an accessor of the glTF scene has no data, or sparse data: export it again.</source>
        <translation>Ein Accessor der glTF-Szene hat keine oder nur dünn besetzte Daten: Exportieren Sie sie erneut.</translation>
    </message>
    <message>
        <source>different bytes in {0}.{1}{2}</source>
        <translation>andere Bytes in {0}.{1}{2}</translation>
    </message>
    <message>
        <source>forces in {0}</source>
        <translation>Kräfte in {0}</translation>
    </message>
    <message>
        <source>forces in {0} with torques in {1}</source>
        <translation>Kräfte in {0} mit Momenten in {1}</translation>
    </message>
    <message>
        <source>has been cut off</source>
        <translation>ist abgeschnitten</translation>
    </message>
    <message>
        <source>has been left out</source>
        <translation>ist ausgelassen</translation>
    </message>
    <message>
        <source>it is damaged, or holds no solids or surfaces</source>
        <translation>sie ist beschädigt oder enthält keine Körper oder Flächen</translation>
    </message>
    <message>
        <source>it is damaged, or holds no surface of polygons (PolyData)</source>
        <translation>sie ist beschädigt oder enthält keine Oberfläche aus Polygonen (PolyData)</translation>
    </message>
    <message>
        <source>no probe has that size in {0}. Check that the right part was exported.</source>
        <translation>keine Sonde ist in {0} so groß. Prüfen Sie, ob das richtige Teil exportiert wurde.</translation>
    </message>
    <message>
        <source>no rate: {0}</source>
        <translation>keine Rate: {0}</translation>
    </message>
    <message>
        <source>no reason given</source>
        <translation>kein Grund angegeben</translation>
    </message>
    <message>
        <source>no reason was given</source>
        <translation>es wurde kein Grund angegeben</translation>
    </message>
    <message>
        <source>no samples for {0} s after {1} s of averaging</source>
        <translation>{0} s lang keine Messwerte, nach {1} s Mittelung</translation>
    </message>
    <message>
        <source>no screen: neither DISPLAY nor WAYLAND_DISPLAY is set, so no window can be opened: start it in a desktop session, or with ssh -X. The other commands (contactbench --help) need no screen.</source>
        <translation>Kein Bildschirm: Weder DISPLAY noch WAYLAND_DISPLAY ist gesetzt, deshalb kann kein Fenster geöffnet werden: Starten Sie contactbench in einer Desktop-Sitzung oder mit ssh -X. Die anderen Befehle (contactbench --help) brauchen keinen Bildschirm.</translation>
    </message>
    <message>
        <source>no single touch explains it</source>
        <translation>keine einzelne Berührung erklärt es</translation>
    </message>
    <message>
        <source>no such topics are there</source>
        <translation>keine solchen Topics sind da</translation>
    </message>
    <message>
        <source>no tissue found within {0} mm.</source>
        <translation>innerhalb von {0} mm war kein Gewebe.</translation>
    </message>
    <message>
        <source>no touch is settled</source>
        <translation>keine Berührung ist eindeutig geortet</translation>
    </message>
    <message>
        <source>no touch was accepted</source>
        <translation>keine Berührung wurde gezählt</translation>
    </message>
    <message>
        <source>no transform gives the position of {0}.</source>
        <translation>keine Transformation sagt, wo {0} ist.</translation>
    </message>
    <message>
        <source>no {0}: {1}</source>
        <translation>kein {0}: {1}</translation>
    </message>
    <message>
        <source>noise of force and torque: give both or neither.</source>
        <translation>Rauschen von Kraft und Moment: Geben Sie beide an oder keines.</translation>
    </message>
    <message>
        <source>noise.extra: the calibration&apos;s share is added automatically: leave it out.</source>
        <translation>noise.extra: Der Anteil der Kalibrierung kommt von selbst hinzu: weglassen.</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keiner</translation>
    </message>
    <message>
        <source>none of the {0} facets has an area: export the part again, as a surface.</source>
        <translation>keine der {0} Facetten hat eine Fläche: Exportieren Sie das Teil neu, als Oberfläche.</translation>
    </message>
    <message>
        <source>none of these contacts has any confidence: turn off confidence weights.</source>
        <translation>keiner dieser Kontakte ist auch nur etwas sicher: Gewichten Sie nicht nach Sicherheit.</translation>
    </message>
    <message>
        <source>none yet</source>
        <translation>noch keine</translation>
    </message>
    <message>
        <source>not a name that a session uses</source>
        <translation>kein Name, den eine Sitzung benutzt</translation>
    </message>
    <message>
        <source>not a port</source>
        <translation>kein Port</translation>
    </message>
    <message>
        <source>not accepted</source>
        <translation>nicht angenommen</translation>
    </message>
    <message>
        <source>not determined yet</source>
        <translation>noch nicht bestimmt</translation>
    </message>
    <message>
        <source>not known</source>
        <translation>nicht bekannt</translation>
    </message>
    <message>
        <source>not listed in provenance.files</source>
        <translation>nicht in provenance.files aufgeführt</translation>
    </message>
    <message>
        <source>not settled</source>
        <translation>nicht ruhig geworden</translation>
    </message>
    <message>
        <source>not the address of a page</source>
        <translation>keine Adresse einer Seite</translation>
    </message>
    <message>
        <source>not verified</source>
        <translation>nicht geprüft</translation>
    </message>
    <message>
        <source>number of facets</source>
        <translation>Anzahl Facetten</translation>
    </message>
    <message>
        <source>numbers in column name</source>
        <translation>Nummern in Spalte name</translation>
    </message>
    <message>
        <source>of the robot, such as ur+tcp://192.168.0.10</source>
        <translation>des Roboters (etwa ur+tcp://192.168.0.10)</translation>
    </message>
    <message>
        <source>of the sensor</source>
        <translation>des Sensors</translation>
    </message>
    <message>
        <source>one of the cells is no number</source>
        <translation>eine der Zellen ist keine Zahl</translation>
    </message>
    <message>
        <source>one part</source>
        <translation>ein Teil</translation>
    </message>
    <message>
        <source>one priority region</source>
        <translation>eine Region mit Priorität</translation>
    </message>
    <message>
        <source>one wrong channel</source>
        <translation>ein falscher Kanal</translation>
    </message>
    <message>
        <source>only a replay or a virtual bench can be stepped: open it with ?speed=step</source>
        <translation>nur eine Wiedergabe oder ein virtueller Prüfstand lässt sich schrittweise fahren: Öffnen Sie sie mit ?speed=step</translation>
    </message>
    <message>
        <source>only {0} of nx,ny,nz is given: give all three, or none.</source>
        <translation>von nx,ny,nz ist nur {0} da: Geben Sie alle drei an, oder keine.</translation>
    </message>
    <message>
        <source>only {0} poses can be reached, fewer than the {1} asked for</source>
        <translation>nur {0} Posen sind erreichbar, weniger als die gewünschten {1}</translation>
    </message>
    <message>
        <source>only {0} wrenches have poses before and after them: record both for longer while the robot turns.</source>
        <translation>nur {0} Kraft-Momenten-Werte haben Posen davor und danach: Zeichnen Sie beides länger auf, während sich der Roboter dreht.</translation>
    </message>
    <message>
        <source>option {0} appears twice: keep one</source>
        <translation>die Option {0} ist zweimal da: nur eine behalten</translation>
    </message>
    <message>
        <source>options: {0}: write them as ?name=value&amp;name=value</source>
        <translation>Optionen: {0}: Schreiben Sie sie als ?name=value&amp;name=value</translation>
    </message>
    <message>
        <source>order: there are no markers {0}: correct the names.</source>
        <translation>Reihenfolge: Diese Marker gibt es nicht: {0}; berichtigen Sie die Namen.</translation>
    </message>
    <message>
        <source>orientation_sigma is {0} rad: give at least 0 and less than {1} rad, not degrees</source>
        <translation>orientation_sigma ist {0} rad: Geben Sie mindestens 0 und weniger als {1} rad an, nicht Grad</translation>
    </message>
    <message>
        <source>orientations of poses {0} and {1} swapped</source>
        <translation>Orientierungen der Posen {0} und {1} vertauscht</translation>
    </message>
    <message>
        <source>orientations shifted by one row to the {0}</source>
        <translation>Orientierungen um eine Zeile verschoben ({0})</translation>
    </message>
    <message>
        <source>orientations transposed</source>
        <translation>Orientierungen transponiert</translation>
    </message>
    <message>
        <source>origin of the box</source>
        <translation>Ursprung des Quaders</translation>
    </message>
    <message>
        <source>outside the force range</source>
        <translation>außerhalb des Kraftbereichs</translation>
    </message>
    <message>
        <source>outside the time window</source>
        <translation>außerhalb des Zeitfensters</translation>
    </message>
    <message>
        <source>over 1000 to 1</source>
        <translation>über 1000 zu 1</translation>
    </message>
    <message>
        <source>parameter pose_kind: it is {0}: give {1}.</source>
        <translation>Parameter pose_kind: er ist {0}: {1} angeben.</translation>
    </message>
    <message>
        <source>parameter {0}: {1}: correct it.</source>
        <translation>Parameter {0}: {1}: Berichtigen Sie ihn.</translation>
    </message>
    <message>
        <source>pass</source>
        <translation>angeben</translation>
    </message>
    <message>
        <source>patch {0}: give flat, or the radii of the touched surface along S&apos;s x and y, mm, such as 80,0.</source>
        <translation>patch {0}: Geben Sie flat an oder die Radien des Berührten in x und y von S, mm, etwa 80,0.</translation>
    </message>
    <message>
        <source>path {0}: a socket has no path: leave it out</source>
        <translation>Pfad {0}: ein Socket hat keinen: weglassen</translation>
    </message>
    <message>
        <source>path: give the {0} after three slashes: ://{1}</source>
        <translation>Pfad: Geben Sie {0} nach drei Schrägstrichen an: ://{1}</translation>
    </message>
    <message>
        <source>path_conflict: step must be above 0 rad, not {0}</source>
        <translation>path_conflict: step muss über 0 rad liegen, nicht {0}</translation>
    </message>
    <message>
        <source>payload: centre of mass {0}: give three numbers, m.</source>
        <translation>Nutzlast: Schwerpunkt {0}: Geben Sie drei Zahlen an, m.</translation>
    </message>
    <message>
        <source>payload: positions must be finite, and the mass of the sensor finite and not negative</source>
        <translation>payload: Orte müssen endlich sein, die Masse des Sensors endlich und nicht negativ</translation>
    </message>
    <message>
        <source>payload: the calibration has no load: weigh the tool that the robot is to carry</source>
        <translation>payload: Die Kalibrierung hat keine Last: Wiegen Sie das Werkzeug, das der Roboter tragen soll</translation>
    </message>
    <message>
        <source>payload: {0} kg, gyration {1} m: give positive numbers.</source>
        <translation>Nutzlast: {0} kg, Trägheitsradius {1} m: Geben Sie positive Zahlen an.</translation>
    </message>
    <message>
        <source>peak force</source>
        <translation>größte Kraft</translation>
    </message>
    <message>
        <source>placement: {0} m is not between 0 and 0.05: give metres, such as 0.0003.</source>
        <translation>placement: {0} m ist nicht zwischen 0 und 0.05: Geben Sie Meter an, etwa 0.0003.</translation>
    </message>
    <message>
        <source>plane_P lies on the axis: pick it to the side, towards +x of S.</source>
        <translation>plane_P: liegt auf der Achse: Wählen Sie den Punkt seitlich davon, zu +x von S hin.</translation>
    </message>
    <message>
        <source>platform: amplitude {0}: give six finite numbers, m and rad.</source>
        <translation>Plattform: Ausschlag {0}: Geben Sie sechs endliche Zahlen an, m und rad.</translation>
    </message>
    <message>
        <source>platform: axis {0}: give one of {1}.</source>
        <translation>Plattform: Achse {0}: Geben Sie eine an von {1}.</translation>
    </message>
    <message>
        <source>platform: period {0} s, start {1} s, ease {2} s: the period must be positive, the others 0 or more.</source>
        <translation>Plattform: Periode {0} s, Start {1} s, Übergang {2} s: Die Periode muss positiv sein, die anderen mindestens 0.</translation>
    </message>
    <message>
        <source>plug in the device, or choose another of the listed ports</source>
        <translation>das Gerät einstecken oder einen anderen der aufgelisteten Anschlüsse wählen</translation>
    </message>
    <message>
        <source>points up ({0} N against world.down_W).</source>
        <translation>zeigt nach oben ({0} N entgegen world.down_W).</translation>
    </message>
    <message>
        <source>points: give finite numbers (n, 3), m, not shape {0}.</source>
        <translation>points: endliche Zahlen (n, 3) in m angeben, nicht die Form {0}.</translation>
    </message>
    <message>
        <source>port {0} cannot be used ({1}): choose another, or 0 for any free port.</source>
        <translation>Port {0}: Er kann nicht benutzt werden ({1}): einen anderen wählen, oder 0 für einen beliebigen freien.</translation>
    </message>
    <message>
        <source>port: give a whole number from 1 to 65535, or none for {0}</source>
        <translation>Port: eine ganze Zahl von 1 bis 65535 angeben, oder keine für {0}</translation>
    </message>
    <message>
        <source>pose</source>
        <translation>neuen Pose</translation>
    </message>
    <message>
        <source>pose rate</source>
        <translation>Posenrate</translation>
    </message>
    <message>
        <source>pose {0}</source>
        <translation>Pose {0}</translation>
    </message>
    <message>
        <source>pose {0} at {1}</source>
        <translation>Pose {0} bei {1}</translation>
    </message>
    <message>
        <source>pose {0} at {1} s</source>
        <translation>Pose {0} bei {1} s</translation>
    </message>
    <message>
        <source>pose: give one of rpy=0,90,0 (degrees about the fixed x, y, z axes), quaternion=w,x,y,z or robot=elfin3&amp;joints=... (degrees)</source>
        <translation>Pose: Geben Sie eines an von rpy=0,90,0 (Grad um die festen Achsen x, y, z), quaternion=w,x,y,z oder robot=elfin3&amp;joints=... (Grad)</translation>
    </message>
    <message>
        <source>poses</source>
        <translation>neuen Posen</translation>
    </message>
    <message>
        <source>prepare the probe in step 3, Probe</source>
        <translation>bereiten Sie die Sonde in Schritt 3, Sonde, vor</translation>
    </message>
    <message>
        <source>press harder, or allow a larger sigma</source>
        <translation>drücken Sie stärker, oder erlauben Sie ein größeres Sigma</translation>
    </message>
    <message>
        <source>press {0}: give a force from 0 to 1000 N, a tilt from 0 to under 90 degrees, and a torsion of at most {1} N·m.</source>
        <translation>Druck {0}: Geben Sie eine Kraft von 0 bis 1000 N an, eine Neigung von 0 bis unter 90 Grad und eine Torsion von höchstens {1} N·m.</translation>
    </message>
    <message>
        <source>previous</source>
        <translation>vorige</translation>
    </message>
    <message>
        <source>prior: {0}</source>
        <translation>Vorwissen: {0}</translation>
    </message>
    <message>
        <source>probe and mesh: give only one of them</source>
        <translation>probe und mesh: nur eines davon angeben</translation>
    </message>
    <message>
        <source>probe {0}: no part of it lies within 12 mm of its tip: check that it is aligned.</source>
        <translation>Sonde {0}: Kein Teil von ihr liegt innerhalb von 12 mm um ihre Spitze: Prüfen Sie, ob sie ausgerichtet ist.</translation>
    </message>
    <message>
        <source>profile {0}: choose one of {1}.</source>
        <translation>Profil {0}: eines von diesen wählen: {1}.</translation>
    </message>
    <message>
        <source>quaternion: its length is not 1: check its four numbers w,x,y,z</source>
        <translation>quaternion: die Länge ist nicht 1: die vier Zahlen w,x,y,z prüfen</translation>
    </message>
    <message>
        <source>quaternions</source>
        <translation>Quaternionen</translation>
    </message>
    <message>
        <source>quaternions in the order {0}</source>
        <translation>Quaternionen in der Reihenfolge {0}</translation>
    </message>
    <message>
        <source>quirk {0}: not available for {1}. Choose from: {2}.</source>
        <translation>Eigenheit {0}: für {1} nicht verfügbar. Möglich: {2}.</translation>
    </message>
    <message>
        <source>r11 to r33 are no rotation: check the columns and their order.</source>
        <translation>r11 bis r33 sind keine Drehung: die Spalten und ihre Reihenfolge prüfen.</translation>
    </message>
    <message>
        <source>radians</source>
        <translation>Radiant</translation>
    </message>
    <message>
        <source>rate {0}: give a number of frames per second from 0.01 to 100000.</source>
        <translation>Rate {0}: eine Anzahl Frames pro Sekunde von 0.01 bis 100000 angeben.</translation>
    </message>
    <message>
        <source>rate: a fixed pose needs at most {0} Hz</source>
        <translation>rate: eine feste Pose braucht höchstens {0} Hz</translation>
    </message>
    <message>
        <source>rate: {0} samples/s are too many for {1} bit/s: choose at most {2}, or a faster line if the device is set to one</source>
        <translation>rate: {0} Messwerte/s sind zu viele für {1} bit/s: höchstens {2} wählen, oder eine schnellere Leitung, falls das Gerät auf eine eingestellt ist</translation>
    </message>
    <message>
        <source>raw forces in N, torques in N·m, in the sensor frame S, and its orientation</source>
        <translation>rohe Kräfte in N, Momente in N·m, im Sensorsystem S, und seine Orientierung</translation>
    </message>
    <message>
        <source>raw has {0} rows for {1} poses: give the numbers behind each pose, in order.</source>
        <translation>raw hat {0} Zeilen für {1} Posen: Geben Sie der Reihe nach die Zahlen hinter jeder Pose an.</translation>
    </message>
    <message>
        <source>raw row {0} is not the orientation of pose {1}, unlike the other rows: give the numbers that the poses were made from, and their convention.</source>
        <translation>raw, Zeile {0}, ist anders als die übrigen Zeilen nicht die Orientierung von Pose {1}: Geben Sie die Zahlen an, aus denen die Posen berechnet wurden, und ihre Konvention.</translation>
    </message>
    <message>
        <source>re-zero</source>
        <translation>Nullen</translation>
    </message>
    <message>
        <source>re-zero before pose {0}</source>
        <translation>neu genullt vor Pose {0}</translation>
    </message>
    <message>
        <source>read DAE</source>
        <translation>DAE lesen</translation>
    </message>
    <message>
        <source>read STEP</source>
        <translation>STEP lesen</translation>
    </message>
    <message>
        <source>read VTK</source>
        <translation>VTK lesen</translation>
    </message>
    <message>
        <source>reality: there is no effect {0}: choose from {1}.</source>
        <translation>reality: Es gibt keinen Effekt {0}: wählen aus {1}.</translation>
    </message>
    <message>
        <source>reality: {0} appears twice: keep one.</source>
        <translation>reality: {0} steht zweimal da: eines behalten.</translation>
    </message>
    <message>
        <source>reality: {0} {1}: give a number, {2}.</source>
        <translation>reality: {0} {1}: eine Zahl angeben, {2}.</translation>
    </message>
    <message>
        <source>reality: {0} {1}: {2} ({3}).</source>
        <translation>reality: {0} {1}: {2} ({3}).</translation>
    </message>
    <message>
        <source>reality: {0}: start with one of {1}, and write effects as NAME=SIZE.</source>
        <translation>reality: {0}: Beginnen Sie mit {1}, und schreiben Sie Effekte als NAME=GRÖSSE.</translation>
    </message>
    <message>
        <source>record {0} at byte {1}</source>
        <translation>Eintrag {0} bei Byte {1}</translation>
    </message>
    <message>
        <source>record {0} at byte {1} does not follow the one before: records were removed, inserted or changed</source>
        <translation>Eintrag {0} bei Byte {1} folgt nicht auf den davor: Einträge wurden entfernt, eingefügt oder geändert</translation>
    </message>
    <message>
        <source>record {0} contains invalid JSON ({1}): restore the session from a backup.</source>
        <translation>Eintrag {0} enthält ungültiges JSON ({1}): Stellen Sie die Sitzung aus einer Sicherung wieder her.</translation>
    </message>
    <message>
        <source>record {0} is not a JSON object: restore the session from a backup.</source>
        <translation>Eintrag {0} ist kein JSON-Objekt: Stellen Sie die Sitzung aus einer Sicherung wieder her.</translation>
    </message>
    <message>
        <source>record {0}: session_created must be the first record and appear only once.</source>
        <translation>Eintrag {0}: session_created muss der erste Eintrag sein und nur einmal vorkommen.</translation>
    </message>
    <message>
        <source>record {0}: {1}: {2}: restore the session from a backup, or use the contactbench that wrote it.</source>
        <translation>Eintrag {0}: {1}: {2}: Stellen Sie die Sitzung aus einer Sicherung wieder her, oder benutzen Sie das contactbench, das ihn geschrieben hat.</translation>
    </message>
    <message>
        <source>recording: two or more rows of six numbers with increasing times are needed.</source>
        <translation>Aufzeichnung: Sie braucht mindestens zwei Zeilen mit sechs Zahlen, zu aufsteigenden Zeiten.</translation>
    </message>
    <message>
        <source>refused it</source>
        <translation>lehnte es ab</translation>
    </message>
    <message>
        <source>region has shape {0}, but there are {1} facets: give one integer per facet.</source>
        <translation>region hat die Form {0}, aber es gibt {1} Facetten: eine ganze Zahl pro Facette angeben.</translation>
    </message>
    <message>
        <source>region must be integers, not {0}: 0 for no region, 1 for the first priority.</source>
        <translation>region müssen ganze Zahlen sein, nicht {0}: 0 für keine Region, 1 für die erste Priorität.</translation>
    </message>
    <message>
        <source>region {0} of the file is not an object with a name and a colour.</source>
        <translation>Region {0} der Datei ist kein Objekt mit Name und Farbe.</translation>
    </message>
    <message>
        <source>region {0}: facet {1} is listed twice: a facet has at most one region.</source>
        <translation>Region {0}: Facette {1} ist zweimal aufgeführt: Eine Facette hat höchstens eine Region.</translation>
    </message>
    <message>
        <source>region {0}: facets[{1}] is not a run [first, count] of two integers.</source>
        <translation>Region {0}: facets[{1}] ist kein Lauf [erste, Anzahl] aus zwei ganzen Zahlen.</translation>
    </message>
    <message>
        <source>region {0}: facets[{1}] is {2}, but facets run from 0 to {3}.</source>
        <translation>Region {0}: facets[{1}] ist {2}, aber die Facetten gehen von 0 bis {3}.</translation>
    </message>
    <message>
        <source>region {0}: {1} is not a colour: write it as #rrggbb.</source>
        <translation>Region {0}: {1} ist keine Farbe: Schreiben Sie sie als #rrggbb.</translation>
    </message>
    <message>
        <source>region: row {0} is {1}: use 0 for no region, 1 for the first priority, and so on.</source>
        <translation>region: Zeile {0} ist {1}: 0 für keine Region verwenden, 1 für die erste Priorität, und so weiter.</translation>
    </message>
    <message>
        <source>rejected</source>
        <translation>verworfen</translation>
    </message>
    <message>
        <source>release force {0} N: give a value above 0 and up to {1} N.</source>
        <translation>Kraft beim Loslassen {0} N: Geben Sie eine über 0 und bis {1} N an.</translation>
    </message>
    <message>
        <source>remove the row, or measure the point again.</source>
        <translation>Entfernen Sie die Zeile, oder messen Sie den Punkt noch einmal.</translation>
    </message>
    <message>
        <source>remove the row, or pass --allow-nan to get the answer not_finite.</source>
        <translation>die Zeile entfernen, oder --allow-nan angeben, damit sie mit not_finite beantwortet wird.</translation>
    </message>
    <message>
        <source>remove the row, or touch the marker again.</source>
        <translation>Entfernen Sie die Zeile, oder berühren Sie den Marker noch einmal.</translation>
    </message>
    <message>
        <source>remove the row, or use --allow-nan to pass it through.</source>
        <translation>Entfernen Sie die Zeile, oder geben Sie sie mit --allow-nan weiter.</translation>
    </message>
    <message>
        <source>remove the row.</source>
        <translation>entfernen Sie die Zeile.</translation>
    </message>
    <message>
        <source>reorder regions</source>
        <translation>Regionen umordnen</translation>
    </message>
    <message>
        <source>residual_m: {0} is not a length of at least 0 m.</source>
        <translation>residual_m: {0} ist keine Länge von mindestens 0 m.</translation>
    </message>
    <message>
        <source>returned a nonsensical answer</source>
        <translation>gab eine unsinnige Antwort</translation>
    </message>
    <message>
        <source>rise</source>
        <translation>steigen</translation>
    </message>
    <message>
        <source>robot {0} has no capsules: its clearance cannot be checked</source>
        <translation>der Roboter {0} hat keine Kapseln: Sein Freiraum kann nicht geprüft werden</translation>
    </message>
    <message>
        <source>robot {0}: it has {1} joints, and the lines have {2}: declare q1 to q{3}.</source>
        <translation>Roboter {0}: Er hat {1} Gelenke, die Zeilen haben {2}: Deklarieren Sie q1 bis q{3}.</translation>
    </message>
    <message>
        <source>robot {0}: its mount holds the sensor unturned, but the bundle says that it is turned: give {1}.</source>
        <translation>Roboter {0}: Seine Halterung hält den Sensor ungedreht, aber das Paket sagt, dass er gedreht ist: {1} angeben.</translation>
    </message>
    <message>
        <source>robot {0}: motion is only sent to a virtual robot, never to a real one: give {1}. A real arm needs its maker&apos;s controller, which loads the same bundle.</source>
        <translation>Roboter {0}: Bewegungen gehen immer nur an einen virtuellen Roboter, nie an einen echten: {1} angeben. Ein echter Arm ist Sache der Steuerung seines Herstellers, die dasselbe Paket lädt.</translation>
    </message>
    <message>
        <source>robot: joints need their robot, and nothing else does</source>
        <translation>robot: Zu joints gehört der Roboter, zu anderem nicht</translation>
    </message>
    <message>
        <source>robot: name the robot of q1,q2,..., and only with these</source>
        <translation>robot: Nennen Sie den Roboter zu q1,q2,..., und nur dazu</translation>
    </message>
    <message>
        <source>ros2.yaml holds only the broadcaster&apos;s offset: the admittance controller of ros2_control cannot take the weight of a tool whose robot is on a wall or a tilted base.</source>
        <translation>ros2.yaml enthält nur den Nullpunktfehler des Broadcasters: Der Admittanzregler von ros2_control kann das Gewicht eines Werkzeugs nicht verrechnen, dessen Roboter an einer Wand oder auf einer geneigten Basis steht.</translation>
    </message>
    <message>
        <source>ros2_yaml: broadcaster and admittance are both {0}: name two nodes</source>
        <translation>ros2_yaml: broadcaster und admittance sind beide {0}: zwei Knoten nennen</translation>
    </message>
    <message>
        <source>rotation matrix</source>
        <translation>Rotationsmatrix</translation>
    </message>
    <message>
        <source>rotation vector</source>
        <translation>Rotationsvektor</translation>
    </message>
    <message>
        <source>rotation vectors</source>
        <translation>Rotationsvektoren</translation>
    </message>
    <message>
        <source>rotation: give vector or rpy with rx,ry,rz, and only with these</source>
        <translation>rotation: Geben Sie zu rx,ry,rz vector oder rpy an, und nur dazu</translation>
    </message>
    <message>
        <source>rotation: {0} goes beyond ±360: give degrees about the fixed axes x, y, z.</source>
        <translation>rotation: {0} geht über ±360 hinaus: Geben Sie Grad um die festen Achsen x, y, z an.</translation>
    </message>
    <message>
        <source>row {0} of the PLY element &apos;{1}&apos;</source>
        <translation>Zeile {0} des PLY-Elements &apos;{1}&apos;</translation>
    </message>
    <message>
        <source>row {0} of the PLY element &apos;{1}&apos; does not contain the numbers that the header announces: the file is damaged, export it again.</source>
        <translation>Zeile {0} des PLY-Elements &apos;{1}&apos; enthält nicht die Zahlen, die der Kopf ankündigt: die Datei ist beschädigt, neu exportieren.</translation>
    </message>
    <message>
        <source>row {0}: {1}</source>
        <translation>Zeile {0}: {1}</translation>
    </message>
    <message>
        <source>rows were moved</source>
        <translation>Zeilen verschoben wurden</translation>
    </message>
    <message>
        <source>run `contactbench probe prepare --units` to make a probe with a confirmed unit.</source>
        <translation>mit `contactbench probe prepare --units` eine Sonde mit bestätigter Einheit erzeugen.</translation>
    </message>
    <message>
        <source>sample {0}: {1}</source>
        <translation>Messwert {0}: {1}</translation>
    </message>
    <message>
        <source>samples={0} are too few to detect hidden surfaces: give at least 100.</source>
        <translation>samples={0} sind zu wenige, um Verdecktes zu erkennen: mindestens 100 angeben.</translation>
    </message>
    <message>
        <source>scheme {0}: start it with one of {1}, then ://</source>
        <translation>Schema {0}: Beginnen Sie mit {1}, dann ://</translation>
    </message>
    <message>
        <source>seconds</source>
        <translation>Sekunden</translation>
    </message>
    <message>
        <source>see its report</source>
        <translation>siehe den Bericht</translation>
    </message>
    <message>
        <source>select at least one column of numbers</source>
        <translation>mindestens eine Spalte mit Zahlen wählen</translation>
    </message>
    <message>
        <source>select columns before reading rows</source>
        <translation>Spalten wählen, bevor Zeilen gelesen werden</translation>
    </message>
    <message>
        <source>self_test.file is {0}, and that is not what the bundle holds. {1}</source>
        <translation>self_test.file ist {0}, und das entspricht nicht dem Inhalt des Pakets. {1}</translation>
    </message>
    <message>
        <source>sensor model {0}: choose one of {1}.</source>
        <translation>Sensormodell {0}: Wählen Sie eines von diesen: {1}.</translation>
    </message>
    <message>
        <source>sensor model: crosstalk: give six rows of six finite numbers.</source>
        <translation>Sensormodell: crosstalk: Geben Sie sechs Zeilen mit je sechs endlichen Zahlen an.</translation>
    </message>
    <message>
        <source>sensor model: hysteresis of load {0}, creep {1}: give shares from 0 to 1.</source>
        <translation>Sensormodell: Hysterese der Last {0}, Kriechen {1}: Anteile von 0 bis 1 angeben.</translation>
    </message>
    <message>
        <source>sensor model: rate {0} Hz: give one above 0, up to {1}.</source>
        <translation>Sensormodell: Rate {0} Hz: Geben Sie eine über 0 und bis {1} an.</translation>
    </message>
    <message>
        <source>sensor model: warm-up {0}: give kelvin and a positive time, s.</source>
        <translation>Sensormodell: Aufwärmen {0}: Geben Sie Kelvin und eine positive Zeit an, s.</translation>
    </message>
    <message>
        <source>sensor model: {0}: give numbers of 0 or more, not {1}.</source>
        <translation>Sensormodell: {0}: Geben Sie Zahlen ab 0 an, nicht {1}.</translation>
    </message>
    <message>
        <source>sensor model: {0}: give six finite numbers, not {1}.</source>
        <translation>Sensormodell: {0}: Geben Sie sechs endliche Zahlen an, nicht {1}.</translation>
    </message>
    <message>
        <source>sensor of {0}</source>
        <translation>Sensor von {0}</translation>
    </message>
    <message>
        <source>sensor turned by {0} about z on the flange</source>
        <translation>Sensor auf dem Flansch um {0} um z gedreht</translation>
    </message>
    <message>
        <source>sensor turned by {0} on the flange</source>
        <translation>Sensor auf dem Flansch um {0} gedreht</translation>
    </message>
    <message>
        <source>sensor z straight down</source>
        <translation>Sensor-z senkrecht nach unten</translation>
    </message>
    <message>
        <source>sensor z straight up</source>
        <translation>Sensor-z senkrecht nach oben</translation>
    </message>
    <message>
        <source>sensor z {0}° from straight down, bearing {1}° from the world&apos;s x axis; {2}</source>
        <translation>Sensor-z {0}° von senkrecht nach unten, in Richtung {1}° von der x-Achse der Welt; {2}</translation>
    </message>
    <message>
        <source>serial number</source>
        <translation>Seriennummer</translation>
    </message>
    <message>
        <source>serial number {0}</source>
        <translation>Seriennummer {0}</translation>
    </message>
    <message>
        <source>serial port</source>
        <translation>serieller Anschluss</translation>
    </message>
    <message>
        <source>servo: period, bandwidth, stiffness and counts are {0}: give positive numbers.</source>
        <translation>Servo: Periode, Bandbreite, Steifigkeit und Zählschritte sind {0}: Geben Sie positive Zahlen an.</translation>
    </message>
    <message>
        <source>set-point {0}: give {1} finite numbers.</source>
        <translation>Sollwert {0}: Geben Sie endliche Zahlen an, Anzahl: {1}.</translation>
    </message>
    <message>
        <source>set-points every {0} s, speeds up to {1}, accelerations up to {2}: give positive numbers.</source>
        <translation>Sollwerte alle {0} s, Geschwindigkeiten bis {1}, Beschleunigungen bis {2}: Geben Sie positive Zahlen an.</translation>
    </message>
    <message>
        <source>share: a second tip presses with this part of the force, 30 mm away.</source>
        <translation>Anteil: Eine zweite Spitze drückt mit diesem Teil der Kraft, 30 mm entfernt.</translation>
    </message>
    <message>
        <source>share: of the cable&apos;s pull held by friction, so that it depends on the way the tool got there.</source>
        <translation>Anteil: des Kabelzugs, den Reibung hält, sodass er davon abhängt, wie das Werkzeug dorthin kam.</translation>
    </message>
    <message>
        <source>share: of the pad&apos;s friction (0.4 times its pressure) used by a twist.</source>
        <translation>Anteil: der Reibung des Kissens, 0,4-mal sein Druck, den eine Drehung nimmt.</translation>
    </message>
    <message>
        <source>signal: {0} numbers were given: give six.</source>
        <translation>Signal: {0} Zahlen: sechs angeben.</translation>
    </message>
    <message>
        <source>skipped on purpose: {0}: contacts there are not verified</source>
        <translation>absichtlich ausgelassen: {0}: Kontakte dort sind nicht geprüft</translation>
    </message>
    <message>
        <source>skipped: give the reason for skipping {0}.</source>
        <translation>ausgelassen: Geben Sie den Grund an für: {0}.</translation>
    </message>
    <message>
        <source>skipped: there are no markers {0}: correct the names.</source>
        <translation>ausgelassen: Diese Marker gibt es nicht: {0}; berichtigen Sie die Namen.</translation>
    </message>
    <message>
        <source>standard input</source>
        <translation>Standardeingabe</translation>
    </message>
    <message>
        <source>standard input: readings and orientations are in different rows: save the table, and give the file.</source>
        <translation>Standardeingabe: Messwerte und Orientierungen stehen in verschiedenen Zeilen: die Tabelle speichern und die Datei angeben.</translation>
    </message>
    <message>
        <source>standard output</source>
        <translation>Standardausgabe</translation>
    </message>
    <message>
        <source>stay where you are</source>
        <translation>bleiben Sie, wo Sie sind</translation>
    </message>
    <message>
        <source>step {0} of &apos;history&apos; is not an object with a name: correct it, or remove it.</source>
        <translation>Schritt {0} von &apos;history&apos; ist kein Objekt mit Namen: Berichtigen oder entfernen Sie ihn.</translation>
    </message>
    <message>
        <source>step {0} of {1} lacks its text, entry or regions.</source>
        <translation>Schritt {0} von {1} fehlen Text, Eintrag oder Regionen.</translation>
    </message>
    <message>
        <source>stiffness {0} N/m: give a number above 0; soft tissue has 300 to 20,000.</source>
        <translation>Steifigkeit {0} N/m: eine Zahl über 0 angeben; weiches Gewebe hat 300 bis 20,000.</translation>
    </message>
    <message>
        <source>t,fx,fy,fz,mx,my,mz and the orientation</source>
        <translation>t,fx,fy,fz,mx,my,mz und die Orientierung</translation>
    </message>
    <message>
        <source>text where a number belongs</source>
        <translation>Text, wo eine Zahl hingehört</translation>
    </message>
    <message>
        <source>that channel corrected</source>
        <translation>berichtigtem Kanal</translation>
    </message>
    <message>
        <source>that convention</source>
        <translation>dieser Konvention</translation>
    </message>
    <message>
        <source>that conversion corrected</source>
        <translation>diese Umrechnung berichtigt</translation>
    </message>
    <message>
        <source>that pull taken off</source>
        <translation>abgezogenem Zug</translation>
    </message>
    <message>
        <source>that rotation</source>
        <translation>dieser Drehung</translation>
    </message>
    <message>
        <source>that share of the pose before taken off</source>
        <translation>abgezogenem Anteil der vorigen Pose</translation>
    </message>
    <message>
        <source>the 3MF archive lacks the model {0} that it takes parts from: export it again.</source>
        <translation>das 3MF-Archiv enthält das Modell {0} nicht, aus dem es Teile nimmt: Exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>the 3MF archive unpacks to far more than a model needs: export it again.</source>
        <translation>das 3MF-Archiv ist entpackt weit größer, als ein Modell sein kann: Exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>the 3MF file needs the extension {0}, which is not supported: export the part as plain triangles, as 3MF or STL.</source>
        <translation>die 3MF-Datei braucht die Erweiterung {0}, die nicht gelesen wird: Exportieren Sie das Teil als einfache Dreiecke, als 3MF oder STL.</translation>
    </message>
    <message>
        <source>the 3MF model builds no triangles: export the part again, as a surface.</source>
        <translation>das 3MF-Modell ergibt keine Dreiecke: Exportieren Sie das Teil neu, als Oberfläche.</translation>
    </message>
    <message>
        <source>the 3MF model declares a document type, which is not allowed: export it again.</source>
        <translation>das 3MF-Modell deklariert einen Dokumenttyp, was nicht erlaubt ist: Exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>the 3MF model is encrypted or packed in an unusual way: export it again, unprotected.</source>
        <translation>das 3MF-Modell ist verschlüsselt oder ungewöhnlich gepackt: Exportieren Sie es neu, ohne Schutz.</translation>
    </message>
    <message>
        <source>the 3MF model is not valid XML ({0}): export it again.</source>
        <translation>das 3MF-Modell ist kein gültiges XML ({0}): Exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>the 3MF model nests or repeats its objects too often: export the probe alone.</source>
        <translation>das 3MF-Modell verschachtelt oder wiederholt seine Objekte zu oft: Exportieren Sie die Sonde allein.</translation>
    </message>
    <message>
        <source>the 3MF model places the object {0}, which it does not contain: export it again.</source>
        <translation>das 3MF-Modell platziert das Objekt {0}, das es nicht enthält: Exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>the 3MF model states the unknown unit {0}: export it again.</source>
        <translation>das 3MF-Modell gibt die unbekannte Einheit {0} an: Exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>the GLB file ends within its header: it is cut short, copy or export it again.</source>
        <translation>die GLB-Datei endet in ihrem Kopf: Sie ist abgeschnitten, kopieren oder exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>the GLB file has version {0}, but only version 2 is supported: export it again as GLB 2.0.</source>
        <translation>die GLB-Datei hat Version {0}, unterstützt wird nur 2: Exportieren Sie sie neu als GLB 2.0.</translation>
    </message>
    <message>
        <source>the GLB file holds no description of its scene: it is damaged, export it again.</source>
        <translation>die GLB-Datei enthält keine Beschreibung ihrer Szene: Sie ist beschädigt, exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>the GLB header announces {0} bytes, but the file has {1}: it is cut short, copy or export it again.</source>
        <translation>der GLB-Kopf kündigt {0} Bytes an, aber die Datei hat {1}: Sie ist abgeschnitten, kopieren oder exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>the JSON file beside the mesh does not belong to a probe: move it away, or rename the mesh.</source>
        <translation>die JSON-Datei neben dem Netz gehört nicht zu einer Sonde: Verschieben Sie sie, oder benennen Sie das Netz um.</translation>
    </message>
    <message>
        <source>the JSON file does not hold one object in {}: choose another file.</source>
        <translation>Die JSON-Datei enthält nicht ein Objekt in {}: Wählen Sie eine andere Datei.</translation>
    </message>
    <message>
        <source>the OFF header announces {0} vertices and {1} facets, but the file ends before them: it is cut short, copy or export it again.</source>
        <translation>der OFF-Kopf kündigt {0} Eckpunkte und {1} Facetten an, aber die Datei endet vorher: sie ist abgeschnitten, neu kopieren oder exportieren.</translation>
    </message>
    <message>
        <source>the OFF text does not state its numbers of vertices, facets and edges: export it again.</source>
        <translation>der OFF-Text gibt seine Anzahlen von Eckpunkten, Facetten und Kanten nicht an: neu exportieren.</translation>
    </message>
    <message>
        <source>the PLY element &apos;{0}&apos; has no property, or the same one twice: export the file again.</source>
        <translation>das PLY-Element &apos;{0}&apos; hat keine Eigenschaft, oder eine zweimal: die Datei neu exportieren.</translation>
    </message>
    <message>
        <source>the PLY face property &apos;{0}&apos; is {1}: save it as int, {2}.</source>
        <translation>die PLY-Facetteneigenschaft &apos;{0}&apos; ist {1}: als int speichern, {2}.</translation>
    </message>
    <message>
        <source>the PLY file has no vertices with a number &apos;{0}&apos;: export it again as a mesh.</source>
        <translation>die PLY-Datei enthält keine Eckpunkte mit einer Zahl &apos;{0}&apos;: neu als Netz exportieren.</translation>
    </message>
    <message>
        <source>the PLY file holds no facets (a point cloud?): export it again as a surface.</source>
        <translation>die PLY-Datei enthält keine Facetten (eine Punktwolke?): neu als Oberfläche exportieren.</translation>
    </message>
    <message>
        <source>the PLY header announces {0}, at least {1} bytes, but {2} follow: the file is cut short, copy or export it again.</source>
        <translation>der PLY-Kopf kündigt an: {0}, mindestens {1} Bytes, aber es folgen {2}: die Datei ist abgeschnitten, neu kopieren oder exportieren.</translation>
    </message>
    <message>
        <source>the PLY header announces {0}, but {1} rows follow it: the file is cut short or damaged, copy or export it again.</source>
        <translation>der PLY-Kopf kündigt an: {0}, aber es folgen {1} Zeilen: die Datei ist abgeschnitten oder beschädigt, neu kopieren oder exportieren.</translation>
    </message>
    <message>
        <source>the PLY header has no &apos;end_header&apos; line: the file is cut short, export it again.</source>
        <translation>der PLY-Kopf hat keine Zeile &apos;end_header&apos;: die Datei ist abgeschnitten, neu exportieren.</translation>
    </message>
    <message>
        <source>the PLY header has no &apos;format&apos; line: the file is damaged, export it again.</source>
        <translation>der PLY-Kopf hat keine Zeile &apos;format&apos;: die Datei ist beschädigt, neu exportieren.</translation>
    </message>
    <message>
        <source>the PLY header names an element twice: export the file again.</source>
        <translation>der PLY-Kopf nennt ein Element zweimal: die Datei neu exportieren.</translation>
    </message>
    <message>
        <source>the PLY property &apos;vertex_indices&apos; is not a list of integers: export the file again.</source>
        <translation>die PLY-Eigenschaft &apos;vertex_indices&apos; ist keine Liste ganzer Zahlen: die Datei neu exportieren.</translation>
    </message>
    <message>
        <source>the STL file holds no facets: export the part again.</source>
        <translation>die STL-Datei enthält keine Facetten: Exportieren Sie das Teil neu.</translation>
    </message>
    <message>
        <source>the STL header announces {0} facets, which take {1} bytes, but the file has {2}: it is cut short or is not an STL file. Copy or export it again.</source>
        <translation>der STL-Kopf kündigt {0} Facetten an, die {1} Bytes brauchen, aber die Datei hat {2}: Sie ist abgeschnitten oder keine STL-Datei. Kopieren oder exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>the STL text ends within a facet: it is cut short, copy or export it again.</source>
        <translation>der STL-Text endet in einer Facette: Er ist abgeschnitten, kopieren oder exportieren Sie ihn neu.</translation>
    </message>
    <message>
        <source>the STL text holds facets within facets: export the file again.</source>
        <translation>der STL-Text enthält Facetten in Facetten: Exportieren Sie die Datei neu.</translation>
    </message>
    <message>
        <source>the STL text holds no facets: export the part again.</source>
        <translation>der STL-Text enthält keine Facetten: Exportieren Sie das Teil neu.</translation>
    </message>
    <message>
        <source>the answer is longer than {0} bytes</source>
        <translation>die Antwort ist länger als {0} Bytes</translation>
    </message>
    <message>
        <source>the answer is not HTTP ({0})</source>
        <translation>die Antwort ist kein HTTP ({0})</translation>
    </message>
    <message>
        <source>the archive has no 3D/3dmodel.model: it is not a 3MF file, or is one for printers only. Export the part again.</source>
        <translation>das Archiv enthält kein 3D/3dmodel.model: Es ist keine 3MF-Datei, oder eine nur für Drucker. Exportieren Sie das Teil neu.</translation>
    </message>
    <message>
        <source>the arm cannot move farther: joint limit or singularity.</source>
        <translation>der Arm kann nicht weiter: eine Gelenkgrenze oder eine Singularität.</translation>
    </message>
    <message>
        <source>the arm is not at its commanded position: motion waits until it is.</source>
        <translation>der Arm ist nicht dort, wohin er geschickt wurde: Bis dahin bewegt sich nichts.</translation>
    </message>
    <message>
        <source>the arm missed its commanded position {0} times.</source>
        <translation>der Arm war {0}-mal nicht dort, wohin er geschickt wurde.</translation>
    </message>
    <message>
        <source>the arm {0} does not reach {1} m with this tool: move the phantom (T_BP) nearer, or give joints near there.</source>
        <translation>der Arm {0} erreicht {1} m mit diesem Werkzeug nicht: Rücken Sie das Phantom (T_BP) näher, oder geben Sie Gelenkwinkel nahe dort an.</translation>
    </message>
    <message>
        <source>the arm&apos;s wrist does not reach that orientation: turn the bench another way.</source>
        <translation>das Handgelenk des Arms erreicht diese Orientierung nicht: Drehen Sie den Messplatz anders.</translation>
    </message>
    <message>
        <source>the author of the session&apos;s newest result</source>
        <translation>der Autor des neuesten Ergebnisses der Sitzung</translation>
    </message>
    <message>
        <source>the box goes from {0} to {1} m: each low value must be below the high one.</source>
        <translation>der Quader geht von {0} bis {1} m: Jeder untere Wert muss kleiner sein als der obere.</translation>
    </message>
    <message>
        <source>the box&apos;s orientation is not a rotation: give a 3 x 3 matrix R_SB.</source>
        <translation>die Orientierung des Quaders ist keine Drehung: Geben Sie eine 3 x 3-Matrix R_SB an.</translation>
    </message>
    <message>
        <source>the brush has a radius of {0} m: give a length above 0.</source>
        <translation>der Pinsel hat einen Radius von {0} m: Geben Sie eine Länge über 0 an.</translation>
    </message>
    <message>
        <source>the bundle is not verified{0}: verify and export again, or add --unverified for trials without a person.</source>
        <translation>das Paket ist nicht geprüft{0}: Prüfen und exportieren Sie erneut; oder ergänzen Sie --unverified, für Versuche ohne Personen.</translation>
    </message>
    <message>
        <source>the bundle says so</source>
        <translation>das Bundle gibt es so vor</translation>
    </message>
    <message>
        <source>the bytes are not the start of a message</source>
        <translation>die Bytes sind nicht der Anfang einer Nachricht</translation>
    </message>
    <message>
        <source>the calibration cannot be written</source>
        <translation>Die Kalibrierung kann nicht geschrieben werden</translation>
    </message>
    <message>
        <source>the calibration was refused: recalibrate</source>
        <translation>die Kalibrierung wurde abgelehnt: Kalibrieren Sie neu</translation>
    </message>
    <message>
        <source>the cells cannot be separated ({0}): check the quotes and the line ends.</source>
        <translation>die Zellen lassen sich nicht trennen ({0}): Prüfen Sie die Anführungszeichen und die Zeilenenden.</translation>
    </message>
    <message>
        <source>the centre of its rim, a circle of {0} mm diameter to {1} mm rms</source>
        <translation>die Mitte ihres Rands (Kreis, Durchmesser {0} mm, rund auf {1} mm rms)</translation>
    </message>
    <message>
        <source>the centre of mass lies on the tool&apos;s side</source>
        <translation>der Schwerpunkt liegt auf der Seite des Werkzeugs</translation>
    </message>
    <message>
        <source>the centre of mass lies within the tool</source>
        <translation>der Schwerpunkt liegt innerhalb des Werkzeugs</translation>
    </message>
    <message>
        <source>the centre of mass lies {0} from the sensor</source>
        <translation>der Schwerpunkt liegt {0} vom Sensor entfernt</translation>
    </message>
    <message>
        <source>the centre of mass lies {0} of the sensor</source>
        <translation>der Schwerpunkt liegt, vom Sensor aus, {0}</translation>
    </message>
    <message>
        <source>the centre of mass would lie {0} from the sensor; read this way, {1}</source>
        <translation>der Schwerpunkt läge {0} vom Sensor entfernt, so gelesen {1}</translation>
    </message>
    <message>
        <source>the centre of mass would lie {0} of the sensor</source>
        <translation>der Schwerpunkt läge, vom Sensor aus, {0}</translation>
    </message>
    <message>
        <source>the centre of mass would lie {0} of the sensor; read this way, {1}</source>
        <translation>der Schwerpunkt läge, vom Sensor aus, {0}, so gelesen {1}</translation>
    </message>
    <message>
        <source>the centre of the area inside its rim</source>
        <translation>die Mitte der Fläche innerhalb ihres Rands</translation>
    </message>
    <message>
        <source>the channel f{0} has the wrong sign</source>
        <translation>der Kanal f{0} hat das falsche Vorzeichen</translation>
    </message>
    <message>
        <source>the channel {0}{1} has the wrong sign</source>
        <translation>der Kanal {0}{1} hat das falsche Vorzeichen</translation>
    </message>
    <message>
        <source>the channels f{0} and f{1} are swapped</source>
        <translation>die Kanäle f{0} und f{1} sind vertauscht</translation>
    </message>
    <message>
        <source>the channels of {0} and {1} are swapped</source>
        <translation>die Kanäle von {0} und {1} sind vertauscht</translation>
    </message>
    <message>
        <source>the channels swapped back</source>
        <translation>zurückgetauschten Kanälen</translation>
    </message>
    <message>
        <source>the config cannot be made</source>
        <translation>die Konfiguration lässt sich nicht erstellen</translation>
    </message>
    <message>
        <source>the config cannot be made: {0}.</source>
        <translation>die Konfiguration lässt sich nicht erstellen: {0}.</translation>
    </message>
    <message>
        <source>the config cannot be written ({0}): {1}</source>
        <translation>die Konfiguration kann nicht geschrieben werden ({0}): {1}</translation>
    </message>
    <message>
        <source>the config is not verified and was not written: </source>
        <translation>die Konfiguration ist nicht geprüft und wird nicht geschrieben: </translation>
    </message>
    <message>
        <source>the contact was unknown for {0} s{1}.</source>
        <translation>Wo sie berührt, war {0} s lang nicht bekannt{1}.</translation>
    </message>
    <message>
        <source>the content</source>
        <translation>der Inhalt</translation>
    </message>
    <message>
        <source>the content of {0} does not match the journal</source>
        <translation>der Inhalt von {0} passt nicht zum Journal</translation>
    </message>
    <message>
        <source>the correction of every reading: every contact moves</source>
        <translation>die Korrektur jedes Messwerts: jeder Kontakt verschiebt sich</translation>
    </message>
    <message>
        <source>the crosstalk taken out</source>
        <translation>berichtigtem Übersprechen</translation>
    </message>
    <message>
        <source>the data within the glTF file is damaged ({0}): export it again as GLB.</source>
        <translation>die Daten in der glTF-Datei sind beschädigt ({0}): Exportieren Sie sie neu als GLB.</translation>
    </message>
    <message>
        <source>the description of the glTF scene is not valid JSON ({0}): export it again as GLB.</source>
        <translation>die Beschreibung der glTF-Szene ist kein gültiges JSON ({0}): Exportieren Sie sie neu als GLB.</translation>
    </message>
    <message>
        <source>the description of the glTF scene is over 16 MiB: export the probe alone, as GLB.</source>
        <translation>die Beschreibung der glTF-Szene ist größer als 16 MiB: Exportieren Sie die Sonde allein, als GLB.</translation>
    </message>
    <message>
        <source>the device answers {0}</source>
        <translation>das Gerät antwortet mit {0}</translation>
    </message>
    <message>
        <source>the device closed the connection</source>
        <translation>das Gerät hat die Verbindung geschlossen</translation>
    </message>
    <message>
        <source>the device points elsewhere ({0})</source>
        <translation>das Gerät verweist an eine andere Stelle ({0})</translation>
    </message>
    <message>
        <source>the driver of {0} failed: {1}: update its package</source>
        <translation>der Treiber für {0} ist gescheitert: {1}: Aktualisieren Sie sein Paket</translation>
    </message>
    <message>
        <source>the entry of step {0} of {1} has no name.</source>
        <translation>der Eintrag von Schritt {0} von {1} hat keinen Namen.</translation>
    </message>
    <message>
        <source>the error needs the touched points: open a verification, or give the markers.</source>
        <translation>der Fehler braucht die Punkte, die berührt wurden: eine Überprüfung öffnen oder die Marker angeben.</translation>
    </message>
    <message>
        <source>the errors speak against that, {0} to 1: verify as calibrated</source>
        <translation>die Fehler sprechen {0} zu 1 dagegen: verifizieren Sie mit dem kalibrierten Nullpunkt</translation>
    </message>
    <message>
        <source>the errors speak for that, {0} to 1</source>
        <translation>die Fehler sprechen {0} zu 1 dafür</translation>
    </message>
    <message>
        <source>the facet on line {0} of the STL text</source>
        <translation>die Facette in Zeile {0} des STL-Texts</translation>
    </message>
    <message>
        <source>the facet on line {0} of the STL text must be three &apos;vertex x y z&apos; between &apos;outer loop&apos; and &apos;endloop&apos;: repair that facet or export the file again.</source>
        <translation>die Facette in Zeile {0} des STL-Texts muss dreimal &apos;vertex x y z&apos; zwischen &apos;outer loop&apos; und &apos;endloop&apos; sein: Reparieren Sie die Facette, oder exportieren Sie die Datei neu.</translation>
    </message>
    <message>
        <source>the facet, counted from 0, and the rank of its region, 0 for none</source>
        <translation>die Facette, gezählt ab 0, und der Rang ihrer Region, 0 für keine</translation>
    </message>
    <message>
        <source>the fields of the event {0} cannot be stored ({1})</source>
        <translation>die Felder des Ereignisses {0} lassen sich nicht speichern ({1})</translation>
    </message>
    <message>
        <source>the file cannot be reached ({0}): check the path.</source>
        <translation>die Datei ist nicht erreichbar ({0}): den Pfad prüfen.</translation>
    </message>
    <message>
        <source>the file cannot be read ({0}): check its permissions.</source>
        <translation>die Datei kann nicht gelesen werden ({0}): ihre Zugriffsrechte prüfen.</translation>
    </message>
    <message>
        <source>the file cannot be read ({0}): check the path.</source>
        <translation>die Datei kann nicht gelesen werden ({0}): Prüfen Sie den Pfad.</translation>
    </message>
    <message>
        <source>the file cannot be read ({0}): copy it to another location.</source>
        <translation>die Datei kann nicht gelesen werden ({0}): Kopieren Sie sie an einen anderen Ort.</translation>
    </message>
    <message>
        <source>the file cannot be written</source>
        <translation>Die Datei kann nicht geschrieben werden</translation>
    </message>
    <message>
        <source>the file has more than {0} MiB: export the part as STL.</source>
        <translation>Die Datei hat mehr als {0} MiB: Exportieren Sie das Teil als STL.</translation>
    </message>
    <message>
        <source>the file has more than {0} facets: export the part with fewer. A tolerance of 0.01 mm is finer than any probe needs.</source>
        <translation>die Datei enthält mehr als {0} Facetten: das Teil mit weniger exportieren. Eine Toleranz von 0.01 mm ist feiner, als eine Sonde sie braucht.</translation>
    </message>
    <message>
        <source>the file has the version {0}, newer than {1}: use a newer contactbench.</source>
        <translation>die Datei hat die Version {0}, neuer als {1}: Verwenden Sie ein neueres contactbench.</translation>
    </message>
    <message>
        <source>the file has {0} bytes, more than 512 MiB: export the part with fewer facets.</source>
        <translation>die Datei hat {0} Bytes, mehr als 512 MiB: das Teil mit weniger Facetten exportieren.</translation>
    </message>
    <message>
        <source>the file holds {0} regions, more than {1}: merge some.</source>
        <translation>die Datei enthält {0} Regionen, mehr als {1}: Fassen Sie einige zusammen.</translation>
    </message>
    <message>
        <source>the file is empty, but belongs to the mesh beside it: if --json output is redirected here, send it elsewhere; otherwise delete the file.</source>
        <translation>die Datei ist leer, gehört aber zum Netz daneben: Wenn die Ausgabe von --json hierher umgeleitet ist, leiten Sie sie anderswohin; sonst löschen Sie die Datei.</translation>
    </message>
    <message>
        <source>the file is empty: copy or export it again.</source>
        <translation>die Datei ist leer: neu kopieren oder exportieren.</translation>
    </message>
    <message>
        <source>the file is empty: it needs the header {0} and rows below it.</source>
        <translation>die Datei ist leer: Sie braucht die Kopfzeile {0} und Zeilen darunter.</translation>
    </message>
    <message>
        <source>the file is larger than {0} MiB, too large for regions: choose another.</source>
        <translation>die Datei ist größer als {0} MiB, zu groß für Regionen: Wählen Sie eine andere.</translation>
    </message>
    <message>
        <source>the first line is not &apos;OFF&apos;: this is not a text OFF file of points in space, choose another or export it again.</source>
        <translation>die erste Zeile ist nicht &apos;OFF&apos;: das ist keine OFF-Textdatei mit Punkten im Raum, eine andere wählen oder neu exportieren.</translation>
    </message>
    <message>
        <source>the first line is not &apos;ply&apos;: this is not a PLY file, choose another or export it again.</source>
        <translation>die erste Zeile ist nicht &apos;ply&apos;: das ist keine PLY-Datei, eine andere wählen oder neu exportieren.</translation>
    </message>
    <message>
        <source>the flange&apos;s ax{0} </source>
        <translation>Flansch-Ax{0} </translation>
    </message>
    <message>
        <source>the force is {0} N.</source>
        <translation>die Kraft ist {0} N.</translation>
    </message>
    <message>
        <source>the force oscillated {0} times, now by {1} N.</source>
        <translation>Die Kraft schwang {0}-mal, jetzt um {1} N.</translation>
    </message>
    <message>
        <source>the force oscillates by {0} N although the gain was lowered: holding still.</source>
        <translation>Die Kraft schwingt um {0} N, obwohl die Verstärkung gesenkt wurde: Sie steht still.</translation>
    </message>
    <message>
        <source>the force range goes from {0} N down to {1} N: swap them.</source>
        <translation>der Kraftbereich geht von {0} N hinunter zu {1} N: die beiden vertauschen.</translation>
    </message>
    <message>
        <source>the force range is {0} to {1} N: give two numbers above 0, smaller first.</source>
        <translation>der Kraftbereich ist {0} bis {1} N: Geben Sie zwei Zahlen über 0 an, die kleinere zuerst.</translation>
    </message>
    <message>
        <source>the force residuals {0} from {1} to {2} N</source>
        <translation>{0} die Residuen der Kräfte von {1} auf {2} N</translation>
    </message>
    <message>
        <source>the force residuals {0} from {1} to {2} and the torque residuals {3} from {4} to {5}</source>
        <translation>{0} die Residuen der Kräfte von {1} auf {2} und {3} die Residuen der Drehmomente von {4} auf {5}</translation>
    </message>
    <message>
        <source>the forces are in kgf, not N</source>
        <translation>die Kräfte sind in kgf, nicht in N</translation>
    </message>
    <message>
        <source>the forces are in lbf, not N</source>
        <translation>die Kräfte sind in lbf, nicht in N</translation>
    </message>
    <message>
        <source>the forces are unknown: give the wrenches that the contacts were located from.</source>
        <translation>die Kräfte sind unbekannt: die Kräfte und Momente angeben, aus denen die Kontakte bestimmt wurden.</translation>
    </message>
    <message>
        <source>the forces have the wrong sign</source>
        <translation>die Kräfte haben das falsche Vorzeichen</translation>
    </message>
    <message>
        <source>the friction angle&apos;s range is {0} to {1} degrees: give two numbers from 0 to below 90, smaller first.</source>
        <translation>der Bereich des Reibungswinkels ist {0} bis {1} Grad: Geben Sie zwei Zahlen von 0 bis unter 90 an, die kleinere zuerst.</translation>
    </message>
    <message>
        <source>the full mesh already has an error of {0}, above the limit of {1}: raise the limit.</source>
        <translation>der Fehler des vollen Netzes ist schon {0}, über der Grenze von {1}: Erhöhen Sie die Grenze.</translation>
    </message>
    <message>
        <source>the glTF file is not of version 2: export it again as GLB 2.0.</source>
        <translation>die glTF-Datei hat nicht die Version 2: Exportieren Sie sie neu als GLB 2.0.</translation>
    </message>
    <message>
        <source>the glTF file keeps its data in another file ({0}): export it as GLB, which is one file.</source>
        <translation>die glTF-Datei hat ihre Daten in einer anderen Datei ({0}): Exportieren Sie sie als GLB, das ist eine einzige Datei.</translation>
    </message>
    <message>
        <source>the glTF meshes are compressed with {0}, which is not supported: {1}.</source>
        <translation>die glTF-Netze sind mit {0} komprimiert, was nicht gelesen wird: {1}.</translation>
    </message>
    <message>
        <source>the glTF scene contains &apos;{0}&apos; that violate the format: export it again as GLB.</source>
        <translation>die glTF-Szene enthält &apos;{0}&apos;, die das Format verletzen: Exportieren Sie sie neu als GLB.</translation>
    </message>
    <message>
        <source>the glTF scene has more than {0} nodes or pieces: export the probe alone.</source>
        <translation>die glTF-Szene hat mehr als {0} Knoten oder Stücke: Exportieren Sie die Sonde allein.</translation>
    </message>
    <message>
        <source>the glTF scene has strips or fans: export it again, with separate triangles.</source>
        <translation>Die glTF-Szene enthält Streifen oder Fächer: Exportieren Sie sie erneut, mit einzelnen Dreiecken.</translation>
    </message>
    <message>
        <source>the glTF scene holds no triangles: export the part again, as a surface.</source>
        <translation>die glTF-Szene enthält keine Dreiecke: Exportieren Sie das Teil neu, als Oberfläche.</translation>
    </message>
    <message>
        <source>the glTF scene morphs its meshes: apply the shapes first, and export it again.</source>
        <translation>Die glTF-Szene verformt ihre Netze (Morphing): Wenden Sie die Formen zuerst an und exportieren Sie sie erneut.</translation>
    </message>
    <message>
        <source>the glTF scene needs the extension {0}, which is not supported: export it again without it, or as STL or 3MF.</source>
        <translation>die glTF-Szene braucht die Erweiterung {0}, die nicht gelesen wird: Exportieren Sie sie ohne diese, oder als STL oder 3MF.</translation>
    </message>
    <message>
        <source>the glTF scene refers to an entry of &apos;{0}&apos; that does not exist: export it again.</source>
        <translation>die glTF-Szene verweist auf einen Eintrag von &apos;{0}&apos;, den es nicht gibt: Exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>the gzip file is damaged ({0}): copy or pack it again.</source>
        <translation>Die gzip-Datei ist beschädigt ({0}): Kopieren oder packen Sie sie erneut.</translation>
    </message>
    <message>
        <source>the header announces {0} bytes, more than {1}</source>
        <translation>der Kopf kündigt {0} Bytes an, mehr als {1}</translation>
    </message>
    <message>
        <source>the header describes an array wrongly</source>
        <translation>der Kopf beschreibt ein Array falsch</translation>
    </message>
    <message>
        <source>the header is not JSON</source>
        <translation>der Kopf ist kein JSON</translation>
    </message>
    <message>
        <source>the header lacks its kind, fields or arrays</source>
        <translation>dem Kopf fehlen Art, Felder oder Arrays</translation>
    </message>
    <message>
        <source>the header names an array twice</source>
        <translation>der Kopf nennt ein Array zweimal</translation>
    </message>
    <message>
        <source>the indenter&apos;s azimuth: the surface faces along its axis of reference; give another.</source>
        <translation>der Azimut des Eindringkörpers: Die Fläche zeigt entlang seiner Bezugsachse; geben Sie eine andere an.</translation>
    </message>
    <message>
        <source>the iterative method needs a contact face of at least six facets; mark one as a region</source>
        <translation>das iterative Verfahren braucht eine Kontaktfläche von mindestens sechs Facetten; eine als Region markieren</translation>
    </message>
    <message>
        <source>the key {0} occurs twice in one object: keep one.</source>
        <translation>der Schlüssel {0} kommt in einem Objekt zweimal vor: Behalten Sie einen.</translation>
    </message>
    <message>
        <source>the largest added error is {0} m: give a length above 0.</source>
        <translation>der größte zusätzliche Fehler ist {0} m: Geben Sie eine Länge über 0 an.</translation>
    </message>
    <message>
        <source>the largest deviation</source>
        <translation>die größte Abweichung</translation>
    </message>
    <message>
        <source>the largest error</source>
        <translation>der größte Fehler</translation>
    </message>
    <message>
        <source>the largest part</source>
        <translation>der größte Teil</translation>
    </message>
    <message>
        <source>the largest tilt must be above 0° and at most 180°, not {0}°</source>
        <translation>die größte Neigung muss über 0° und höchstens 180° sein, nicht {0}°</translation>
    </message>
    <message>
        <source>the likeliest, {0}, leaves {1}; unchanged they leave {2}</source>
        <translation>die wahrscheinlichste Lesart, {0}, lässt {1} übrig; unverändert bleiben {2}</translation>
    </message>
    <message>
        <source>the limits of the robot</source>
        <translation>was der Roboter nicht überschreiten darf</translation>
    </message>
    <message>
        <source>the margins</source>
        <translation>die Reserven</translation>
    </message>
    <message>
        <source>the marker</source>
        <translation>der Marker</translation>
    </message>
    <message>
        <source>the markers</source>
        <translation>die Marker</translation>
    </message>
    <message>
        <source>the mass as weighed</source>
        <translation>die Masse wie gewogen</translation>
    </message>
    <message>
        <source>the mass comes out as {0} kg</source>
        <translation>als Masse ergeben sich {0} kg</translation>
    </message>
    <message>
        <source>the mass comes out as {0} kg where {1} kg was weighed</source>
        <translation>als Masse ergeben sich {0} kg, gewogen wurden {1} kg</translation>
    </message>
    <message>
        <source>the mass would be {0} kg; read this way, {1} kg{2}</source>
        <translation>die Masse wäre {0} kg, so gelesen {1} kg{2}</translation>
    </message>
    <message>
        <source>the matrix is not positive semidefinite, so it is not a covariance: {0}</source>
        <translation>die Matrix ist nicht positiv semidefinit, also keine Kovarianz: {0}</translation>
    </message>
    <message>
        <source>the matrix is not symmetric: {0}</source>
        <translation>die Matrix ist nicht symmetrisch: {0}</translation>
    </message>
    <message>
        <source>the mesh has {0} facets, but the regions {1}: load both again.</source>
        <translation>das Netz hat {0} Facetten, die Regionen aber {1}: Laden Sie beide neu.</translation>
    </message>
    <message>
        <source>the mesh has {0} parts that do not touch; the middles of two of them are {1} mm apart. Delete everything that is not the probe in the CAD program, or bridge the gap with a larger value (gap).</source>
        <translation>das Netz hat {0} Teile, die sich nicht berühren; die Mitten von zweien liegen {1} mm auseinander. Löschen Sie im CAD-Programm, was nicht zur Sonde gehört, oder überbrücken Sie die Lücke mit einem größeren Wert (gap).</translation>
    </message>
    <message>
        <source>the message is cut short</source>
        <translation>die Nachricht ist abgeschnitten</translation>
    </message>
    <message>
        <source>the model error: torsion, drift, the mesh</source>
        <translation>der Modellfehler: Torsion, Drift, das Netz</translation>
    </message>
    <message>
        <source>the mount in the settings and the alignment contradict each other: give only one.</source>
        <translation>die Halterung der Einstellungen und eine Ausrichtung widersprechen einander: Geben Sie eines an.</translation>
    </message>
    <message>
        <source>the mount is off by a turn of {0}</source>
        <translation>die Halterung ist um {0} verdreht</translation>
    </message>
    <message>
        <source>the name has no address</source>
        <translation>der Name hat keine Adresse</translation>
    </message>
    <message>
        <source>the name of a marker</source>
        <translation>den Namen eines Markers</translation>
    </message>
    <message>
        <source>the nodes of the glTF scene move or scale a part far too much: export it again.</source>
        <translation>die Knoten der glTF-Szene verschieben oder skalieren ein Teil über alle Grenzen: Exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>the noise comes out as {0}</source>
        <translation>als Rauschen ergeben sich {0}</translation>
    </message>
    <message>
        <source>the noise would be {0}; read this way, {1}</source>
        <translation>das Rauschen wäre {0}, so gelesen {1}</translation>
    </message>
    <message>
        <source>the non-convex polygons have {0} corners, too many to triangulate here: export the part again with triangles only.</source>
        <translation>die nicht konvexen Vielecke haben {0} Ecken, zu viele, um sie hier in Dreiecke zu zerlegen: das Teil neu und nur mit Dreiecken exportieren.</translation>
    </message>
    <message>
        <source>the numbers read as {0}</source>
        <translation>als {0} gelesenen Zahlen</translation>
    </message>
    <message>
        <source>the numbers span {0}, which cannot be a probe in millimetres, metres, centimetres or inches (5 mm to 2 m). Check that the right part was exported.</source>
        <translation>die Zahlen umfassen {0}, was in Millimetern, Metern, Zentimetern oder Zoll keine Sonde sein kann (5 mm bis 2 m). Prüfen Sie, ob das richtige Teil exportiert wurde.</translation>
    </message>
    <message>
        <source>the one in the session</source>
        <translation>das in der Sitzung</translation>
    </message>
    <message>
        <source>the orientation of the flange is a reflection</source>
        <translation>die Orientierung des Flansches ist eine Spiegelung</translation>
    </message>
    <message>
        <source>the orientation of the flange is no rotation</source>
        <translation>die Orientierung des Flansches ist keine Drehung</translation>
    </message>
    <message>
        <source>the orientations are given as {0}: choose one. Pass {1}.</source>
        <translation>die Orientierungen sind angegeben als {0}: Wählen Sie eine Form. Möglich: {1}.</translation>
    </message>
    <message>
        <source>the orientations turned by {0} about the sensor&apos;s z axis</source>
        <translation>die Orientierungen um {0} um die z-Achse des Sensors gedreht</translation>
    </message>
    <message>
        <source>the other side</source>
        <translation>der anderen Seite</translation>
    </message>
    <message>
        <source>the physics diverged ({0}), so later results would be wrong. Push less hard, or turn more slowly.</source>
        <translation>die Physik ist aus den Fugen geraten ({0}): Was danach kam, wäre nicht wahr. Drücken Sie weniger stark, oder drehen Sie langsamer.</translation>
    </message>
    <message>
        <source>the picked point {0} is not a point in space: pick again.</source>
        <translation>der gewählte Punkt {0} ist kein Punkt im Raum: Wählen Sie neu.</translation>
    </message>
    <message>
        <source>the planes for controllers with their own loop</source>
        <translation>die Ebenen für Steuerungen mit eigenem Regelkreis</translation>
    </message>
    <message>
        <source>the plug-in {0} ({1}) of {2} is left out: {3}: repair or uninstall that package</source>
        <translation>das Plug-in {0} ({1}) aus {2} bleibt weg: {3}: Reparieren oder deinstallieren Sie dieses Paket</translation>
    </message>
    <message>
        <source>the point</source>
        <translation>der Punkt</translation>
    </message>
    <message>
        <source>the point {0} mm is {1} mm from the surface, more than {2} mm: give a point on the surface, in mm and in the probe&apos;s frame.</source>
        <translation>der Punkt {0} mm ist {1} mm von der Oberfläche entfernt, mehr als {2} mm: Geben Sie einen auf der Oberfläche an, in mm und im Koordinatensystem der Sonde.</translation>
    </message>
    <message>
        <source>the poses are {0} ms late, so the position is unknown.</source>
        <translation>Die Posen kommen {0} ms zu spät: Wo sie ist, lässt sich nicht wissen.</translation>
    </message>
    <message>
        <source>the poses cannot be written</source>
        <translation>Die Posen können nicht geschrieben werden</translation>
    </message>
    <message>
        <source>the poses have no positions</source>
        <translation>die Posen haben keine Positionen</translation>
    </message>
    <message>
        <source>the poses, all within {0}° of one another, are too similar</source>
        <translation>die Posen, höchstens {0}° auseinander, sind einander zu ähnlich</translation>
    </message>
    <message>
        <source>the position of the flange needs three numbers</source>
        <translation>die Lage des Flanschs braucht drei Zahlen</translation>
    </message>
    <message>
        <source>the preference among candidates</source>
        <translation>was unter den Kandidaten bevorzugt wird</translation>
    </message>
    <message>
        <source>the probe is already in the sensor frame and would be moved twice. Start from the mesh before alignment, or mark this as a correction (again).</source>
        <translation>die Sonde ist schon im Sensorsystem und würde zweimal verschoben. Beginnen Sie mit dem Netz vor der Ausrichtung, oder kennzeichnen Sie dies als Korrektur (again).</translation>
    </message>
    <message>
        <source>the probe is {0} mm long, {1}: {2}</source>
        <translation>die Sonde ist {0} mm lang, {1}: {2}</translation>
    </message>
    <message>
        <source>the probe&apos;s mesh is turned by 180° about the sensor&apos;s {0} axis</source>
        <translation>das Netz der Sonde ist um 180° um die {0}-Achse des Sensors verdreht</translation>
    </message>
    <message>
        <source>the probe&apos;s mesh is turned by {0}° about the sensor&apos;s z axis, or the sensor on its mount</source>
        <translation>das Netz der Sonde ist um {0}° um die z-Achse des Sensors verdreht, oder der Sensor auf seiner Montage</translation>
    </message>
    <message>
        <source>the quaternion has length {0} instead of 1: check the columns qw, qx, qy, qz.</source>
        <translation>das Quaternion hat die Länge {0} statt 1: Prüfen Sie die Spalten qw, qx, qy, qz.</translation>
    </message>
    <message>
        <source>the quaternion has length {0}, not 1: check the columns qw, qx, qy, qz.</source>
        <translation>das Quaternion hat die Länge {0}, nicht 1: Prüfen Sie die Spalten qw, qx, qy, qz.</translation>
    </message>
    <message>
        <source>the reading crept by {0}/s</source>
        <translation>der Messwert kroch um {0}/s</translation>
    </message>
    <message>
        <source>the reading jumped by {0}</source>
        <translation>der Messwert sprang um {0}</translation>
    </message>
    <message>
        <source>the reading shook by {0}</source>
        <translation>der Messwert zitterte um {0}</translation>
    </message>
    <message>
        <source>the readings are fresh, and the arm is at its commanded position.</source>
        <translation>die Messwerte sind frisch, und der Arm ist, wo er sein soll.</translation>
    </message>
    <message>
        <source>the readings at the limit left open</source>
        <translation>offenen Messwerten an der Grenze</translation>
    </message>
    <message>
        <source>the recording contains no samples, so there is nothing to convert.</source>
        <translation>die Aufzeichnung enthält keine Messwerte: Es gibt nichts umzuwandeln.</translation>
    </message>
    <message>
        <source>the recording contains no touch: |F| never reaches {0} N. Check that it is the right recording, and that the calibration belongs to it.</source>
        <translation>die Aufzeichnung enthält keine Berührung: |F| erreicht nie {0} N. Prüfen Sie, ob es die richtige Aufzeichnung ist und ob die Kalibrierung zu ihr gehört.</translation>
    </message>
    <message>
        <source>the recording ended</source>
        <translation>die Aufzeichnung endete</translation>
    </message>
    <message>
        <source>the recording has no samples on {0}; it has: {1}.</source>
        <translation>die Aufzeichnung hat keine Messwerte auf {0}; sie hat: {1}.</translation>
    </message>
    <message>
        <source>the recording has several topics of that kind: {0}. Choose one: --topic NAME.</source>
        <translation>die Aufzeichnung hat mehrere Topics dieser Art: {0}. Wählen Sie eines: --topic NAME.</translation>
    </message>
    <message>
        <source>the region name {0} contains characters that cannot be displayed: leave them out.</source>
        <translation>der Name der Region {0} enthält Zeichen, die nicht gezeigt werden können: Lassen Sie sie weg.</translation>
    </message>
    <message>
        <source>the region ratio is {0}: give 1 for facets spread evenly, up to 100 for more in the regions.</source>
        <translation>das Verhältnis für Regionen ist {0}: Geben Sie 1 für gleichmäßig verteilte Facetten an, bis zu 100 für mehr in den Regionen.</translation>
    </message>
    <message>
        <source>the region {0} ({1} mm²) vanished: the new mesh is too coarse there or has lost that part. Keep more facets, or paint it again.</source>
        <translation>die Region {0} ({1} mm²) ist verschwunden: Das neue Netz ist dort zu grob oder hat diesen Teil verloren. Behalten Sie mehr Facetten, oder malen Sie sie neu.</translation>
    </message>
    <message>
        <source>the regions are for a mesh of {0} facets, this one has {1}. {2}</source>
        <translation>die Regionen sind für ein Netz mit {0} Facetten, dieses hat {1}. {2}</translation>
    </message>
    <message>
        <source>the regions are for another mesh of {0} facets: its vertices or faces differ. {1}</source>
        <translation>die Regionen sind für ein anderes Netz mit {0} Facetten: Seine Eckpunkte oder Facetten weichen ab. {1}</translation>
    </message>
    <message>
        <source>the regions are for {0} facets, but the old mesh has {1}: give the mesh that they belong to.</source>
        <translation>die Regionen sind für {0} Facetten, aber das alte Netz hat {1}: Geben Sie das Netz an, zu dem sie gehören.</translation>
    </message>
    <message>
        <source>the residuals, {0}, do not decide it, but as declared {1}</source>
        <translation>die Restabweichungen, {0}, entscheiden es nicht, aber wie angegeben gilt: {1}</translation>
    </message>
    <message>
        <source>the results on markers</source>
        <translation>was an Markern gemessen wurde</translation>
    </message>
    <message>
        <source>the robot moved on</source>
        <translation>der Roboter fuhr weiter</translation>
    </message>
    <message>
        <source>the robot stood for only {0} s; {1} s after settling are needed</source>
        <translation>der Roboter stand nur {0} s lang; nötig sind {1} s nach dem Beruhigen</translation>
    </message>
    <message>
        <source>the robot stood still, but the reading did not settle: vibration, a moving cable, or a hand</source>
        <translation>der Roboter stand still, aber der Messwert kam nicht zur Ruhe: Vibration, ein bewegtes Kabel oder eine Hand</translation>
    </message>
    <message>
        <source>the rows shifted back</source>
        <translation>zurückverschobenen Zeilen</translation>
    </message>
    <message>
        <source>the schema is missing</source>
        <translation>das Schema fehlt</translation>
    </message>
    <message>
        <source>the schema is {0}</source>
        <translation>das Schema ist {0}</translation>
    </message>
    <message>
        <source>the seed is {0}: give a whole number of at least 0.</source>
        <translation>der Seed ist {0}: Geben Sie eine ganze Zahl von mindestens 0 an.</translation>
    </message>
    <message>
        <source>the sensor is at the end of its range, so the force is unknown.</source>
        <translation>der Sensor ist am Ende seines Messbereichs: Die Kraft kann beliebig groß sein.</translation>
    </message>
    <message>
        <source>the sensor is {0}: no motion on stale readings.</source>
        <translation>Störung des Sensors ({0}): Auf alte Messwerte hin bewegt sich nichts.</translation>
    </message>
    <message>
        <source>the sensor turned</source>
        <translation>der Sensor drehte sich</translation>
    </message>
    <message>
        <source>the sensor&apos;s sample rate is unknown: give the rate it is set to with --rate.</source>
        <translation>die Messrate des Sensors ist unbekannt: mit --rate angeben, wie der Sensor eingestellt ist.</translation>
    </message>
    <message>
        <source>the sensor&apos;s serial number is {0}, but the bundle is for {1}: connect that sensor, or calibrate, verify and export with this one. Add --other-sensor if they are the same.</source>
        <translation>die Seriennummer des Sensors ist {0}, aber das Bundle ist für {1}: diesen Sensor anschließen, oder mit dem vorhandenen kalibrieren, überprüfen und exportieren. Sind es dieselben, --other-sensor angeben.</translation>
    </message>
    <message>
        <source>the session contains nothing with the hash {0}: add it first.</source>
        <translation>die Sitzung enthält nichts mit dem Hash {0}: Fügen Sie es zuerst hinzu.</translation>
    </message>
    <message>
        <source>the share of failed touches is {0}: give a number from 0 to 1.</source>
        <translation>der Anteil gescheiterter Berührungen ist {0}: Geben Sie eine Zahl von 0 bis 1 an.</translation>
    </message>
    <message>
        <source>the signs are reversed</source>
        <translation>die Vorzeichen sind umgekehrt</translation>
    </message>
    <message>
        <source>the speed is {0}: give a number above 0.</source>
        <translation>die Geschwindigkeit ist {0}: Geben Sie eine Zahl über 0 an.</translation>
    </message>
    <message>
        <source>the start is no time</source>
        <translation>der Beginn ist keine Zeit</translation>
    </message>
    <message>
        <source>the stated uncertainty of a contact, and which rivals count</source>
        <translation>die angegebene Unsicherheit eines Kontakts, und welche Rivalen zählen</translation>
    </message>
    <message>
        <source>the step {0} does not belong to these regions.</source>
        <translation>Der Schritt {0} gehört nicht zu diesen Regionen.</translation>
    </message>
    <message>
        <source>the surface cannot be simplified to {0} facets, nor to a few times as many: {1} Choose more facets, or repair the mesh first.</source>
        <translation>die Oberfläche kann nicht auf {0} Facetten vereinfacht werden, auch nicht auf ein paarmal so viele: {1} Wählen Sie mehr Facetten, oder reparieren Sie zuerst das Netz.</translation>
    </message>
    <message>
        <source>the table</source>
        <translation>die Tabelle</translation>
    </message>
    <message>
        <source>the temporary folder</source>
        <translation>der temporäre Ordner</translation>
    </message>
    <message>
        <source>the time window ends at {0} s, before it starts at {1} s: swap them.</source>
        <translation>das Zeitfenster endet bei {0} s, bevor es bei {1} s beginnt: die beiden vertauschen.</translation>
    </message>
    <message>
        <source>the time {0} is no time in s: give times in s</source>
        <translation>Die Zeit {0} ist keine Zeit in s: Zeiten in s angeben</translation>
    </message>
    <message>
        <source>the tip has no target: aim at a marker first.</source>
        <translation>die Spitze zielt auf nichts: Zielen Sie zuerst auf einen Marker.</translation>
    </message>
    <message>
        <source>the tissue pushes with {0} N while the arm stands still.</source>
        <translation>das Gewebe drückt mit {0} N, während sie still steht.</translation>
    </message>
    <message>
        <source>the tissue was lost {0} times.</source>
        <translation>das Gewebe wurde {0}-mal verloren.</translation>
    </message>
    <message>
        <source>the tissue was lost: searching for it again.</source>
        <translation>das Gewebe wurde verloren: Sie sucht es wieder.</translation>
    </message>
    <message>
        <source>the tool on the other side of the sensor</source>
        <translation>das Werkzeug auf der anderen Seite des Sensors</translation>
    </message>
    <message>
        <source>the tool&apos;s side</source>
        <translation>der Seite des Werkzeugs</translation>
    </message>
    <message>
        <source>the torque channels of {0} and {1} are swapped</source>
        <translation>die Drehmomentkanäle von {0} und {1} sind vertauscht</translation>
    </message>
    <message>
        <source>the torque residuals {0} from {1} to {2} mN·m</source>
        <translation>{0} die Residuen der Drehmomente von {1} auf {2} mN·m</translation>
    </message>
    <message>
        <source>the torques are in N·cm, not N·m</source>
        <translation>die Drehmomente sind in N·cm, nicht in N·m</translation>
    </message>
    <message>
        <source>the torques are in N·mm</source>
        <translation>die Drehmomente sind in N·mm</translation>
    </message>
    <message>
        <source>the torques are in N·mm, not N·m</source>
        <translation>die Drehmomente sind in N·mm, nicht in N·m</translation>
    </message>
    <message>
        <source>the torques are in kN·m, or were divided by 1000 once too often</source>
        <translation>die Drehmomente sind in kN·m oder wurden einmal zu oft durch 1000 geteilt</translation>
    </message>
    <message>
        <source>the torques are in kgf·cm, not N·m</source>
        <translation>die Drehmomente sind in kgf·cm, nicht in N·m</translation>
    </message>
    <message>
        <source>the torques are in kgf·m, not N·m</source>
        <translation>die Drehmomente sind in kgf·m, nicht in N·m</translation>
    </message>
    <message>
        <source>the torques are in lbf·ft, not N·m</source>
        <translation>die Drehmomente sind in lbf·ft, nicht in N·m</translation>
    </message>
    <message>
        <source>the torques are in lbf·in, not N·m</source>
        <translation>die Drehmomente sind in lbf·in, nicht in N·m</translation>
    </message>
    <message>
        <source>the torques have the wrong sign</source>
        <translation>die Drehmomente haben das falsche Vorzeichen</translation>
    </message>
    <message>
        <source>the torsion arm is {0} m: give a length of 0 or more, such as 0.0003.</source>
        <translation>der Torsionsarm ist {0} m: Geben Sie eine Länge von 0 oder mehr an, etwa 0.0003.</translation>
    </message>
    <message>
        <source>the total error grows by {0} %, more than {1} %</source>
        <translation>der gesamte Fehler wächst um {0} %, mehr als {1} %</translation>
    </message>
    <message>
        <source>the total error may grow by {0}: give a number above 0, such as 0.05.</source>
        <translation>der gesamte Fehler darf um {0} wachsen: Geben Sie eine Zahl über 0 an, etwa 0.05.</translation>
    </message>
    <message>
        <source>the transform to {0} is no pose</source>
        <translation>die Transformation zu {0} ist keine Pose</translation>
    </message>
    <message>
        <source>the transforms to {0} never have the same time stamp.</source>
        <translation>die Transformationen zu {0} haben nie denselben Zeitstempel.</translation>
    </message>
    <message>
        <source>the triangles of the glTF scene are not three vertices each: export it again.</source>
        <translation>die Dreiecke der glTF-Szene haben nicht je drei Eckpunkte: Exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>the unchanged data</source>
        <translation>die unveränderten Daten</translation>
    </message>
    <message>
        <source>the units corrected</source>
        <translation>die Einheiten berichtigt</translation>
    </message>
    <message>
        <source>the verification has no accepted touch: see its reasons, and touch again.</source>
        <translation>die Überprüfung hat keine gezählte Berührung: ihre Gründe ansehen und noch einmal berühren.</translation>
    </message>
    <message>
        <source>the verification&apos;s gates cannot be read ({0}): verify again.</source>
        <translation>Die Grenzen der Verifikation sind nicht lesbar ({0}): erneut verifizieren.</translation>
    </message>
    <message>
        <source>the virtual bench</source>
        <translation>der virtuelle Messplatz</translation>
    </message>
    <message>
        <source>the virtual bench failed ({0}: {1}): open it again.</source>
        <translation>der virtuelle Messplatz ist gescheitert ({0}: {1}): Öffnen Sie ihn wieder.</translation>
    </message>
    <message>
        <source>the virtual bench has no host or path</source>
        <translation>der virtuelle Messplatz hat weder Host noch Pfad</translation>
    </message>
    <message>
        <source>the virtual robot cannot be started ({0}): check {1}.</source>
        <translation>der virtuelle Roboter kann nicht gestartet werden ({0}): Prüfen Sie {1}.</translation>
    </message>
    <message>
        <source>the virtual robot sent an invalid answer ({0}).</source>
        <translation>der virtuelle Roboter hat eine ungültige Antwort gesendet ({0}).</translation>
    </message>
    <message>
        <source>the virtual robot stopped with code {0}.</source>
        <translation>der virtuelle Roboter endete mit Code {0}.</translation>
    </message>
    <message>
        <source>the whole probe is marked untouchable: correct the regions.</source>
        <translation>Die ganze Sonde ist als unberührbar markiert: Regionen korrigieren.</translation>
    </message>
    <message>
        <source>the window needs {0}, which is not installed: {1}. All other commands work without it.</source>
        <translation>Das Fenster braucht {0}, das nicht installiert ist: {1}. Alle anderen Befehle gehen auch ohne.</translation>
    </message>
    <message>
        <source>the wrench_axis method needs Embree: {0}</source>
        <translation>das Verfahren wrench_axis braucht Embree: {0}</translation>
    </message>
    <message>
        <source>the wrist: a tip is at the tool: release it first.</source>
        <translation>das Handgelenk: Eine Spitze ist am Werkzeug: Lösen Sie sie zuerst.</translation>
    </message>
    <message>
        <source>the wrist: give a rotation matrix.</source>
        <translation>das Handgelenk: Geben Sie eine Drehmatrix an.</translation>
    </message>
    <message>
        <source>the wrist: {0} degrees in {1} s is too fast for an arm: give {2} s or more.</source>
        <translation>das Handgelenk: {0} Grad in {1} s sind schneller als jeder Arm: Geben Sie mindestens {2} s an.</translation>
    </message>
    <message>
        <source>the wrist: {0} s is not a valid duration: give a positive number.</source>
        <translation>das Handgelenk: {0} s ist keine Zeit für eine Drehung: Geben Sie eine positive Zahl an.</translation>
    </message>
    <message>
        <source>the {0} axis lowest ({1}° from straight down)</source>
        <translation>seine Achse {0} am tiefsten ({1}° von senkrecht nach unten)</translation>
    </message>
    <message>
        <source>the {0} error is {1} mm, over {2} mm</source>
        <translation>Fehler ({0}): {1} mm, mehr als {2} mm</translation>
    </message>
    <message>
        <source>the {0} is {1} mm, over the limit of {2} mm</source>
        <translation>der Fehler ({0}) ist {1} mm, über der Grenze von {2} mm</translation>
    </message>
    <message>
        <source>the {0} of the added contact error is {1} mm</source>
        <translation>der zusätzliche Kontaktfehler ({0}) ist {1} mm</translation>
    </message>
    <message>
        <source>the {0} text holds no facets: export the part again, as a surface of triangles.</source>
        <translation>der Text ({0}) enthält keine Facetten: das Teil neu exportieren, als Oberfläche aus Dreiecken.</translation>
    </message>
    <message>
        <source>the {0} turned into the sensor</source>
        <translation>in den Sensor gedreht: {0}</translation>
    </message>
    <message>
        <source>the {0} {1} cannot be relied on, because {2}</source>
        <translation>auf {0} {1} ist kein Verlass: {2}</translation>
    </message>
    <message>
        <source>their angles are more than one turn in radians: {0}</source>
        <translation>ihre Winkel sind im Bogenmaß größer als eine Umdrehung: {0}</translation>
    </message>
    <message>
        <source>their joints are beyond the limits of {0}: {1}</source>
        <translation>ihre Gelenkwinkel liegen außerhalb der Grenzen von {0}: {1}</translation>
    </message>
    <message>
        <source>there are more than {0} rows, too many for a table of still poses</source>
        <translation>es sind mehr als {0} Zeilen, zu viele für eine Tabelle ruhiger Posen</translation>
    </message>
    <message>
        <source>there are no markers: give at least one.</source>
        <translation>es gibt keine Marker: Geben Sie mindestens einen an.</translation>
    </message>
    <message>
        <source>there is a header but no row below it: record again or choose another file.</source>
        <translation>es gibt eine Kopfzeile, aber keine Zeile darunter: Zeichnen Sie neu auf, oder wählen Sie eine andere Datei.</translation>
    </message>
    <message>
        <source>there is already a marker {0}: choose another name.</source>
        <translation>Marker {0} gibt es schon: Wählen Sie einen anderen Namen.</translation>
    </message>
    <message>
        <source>there is no contact to draw: touch the probe while recording, or lower --min-force.</source>
        <translation>es gibt keinen Kontakt zu zeichnen: die Sonde während der Aufzeichnung berühren oder --min-force senken.</translation>
    </message>
    <message>
        <source>there is no contact to draw: touch the probe while recording.</source>
        <translation>es gibt keinen Kontakt zu zeichnen: die Sonde während der Aufzeichnung berühren.</translation>
    </message>
    <message>
        <source>there is no contact with a known {0}: choose another quantity.</source>
        <translation>bei keinem Kontakt ist die Größe {0} bekannt: eine andere Größe wählen.</translation>
    </message>
    <message>
        <source>there is no contact{0}: widen the time window or the force range (the recording lasts {1} s).</source>
        <translation>es gibt keinen Kontakt{0}: das Zeitfenster oder den Kraftbereich erweitern (die Aufzeichnung dauert {1} s).</translation>
    </message>
    <message>
        <source>there is no heatmap of quantity {0} with normalisation {1}.</source>
        <translation>Größe {0}, Normierung {1}: eine solche Heatmap gibt es nicht.</translation>
    </message>
    <message>
        <source>there is no hypothesis {0}. Tested: {1}.</source>
        <translation>die Hypothese {0} gibt es nicht. Geprüft: {1}.</translation>
    </message>
    <message>
        <source>there is no method {0}: choose one of {1}</source>
        <translation>ein Verfahren {0} gibt es nicht; eines von diesen wählen: {1}</translation>
    </message>
    <message>
        <source>there is no mix {0}</source>
        <translation>Es gibt keine Mischung {0}</translation>
    </message>
    <message>
        <source>there is no orientation ({0}) beside the readings: add it, or give the robot&apos;s poses as a separate table, --robot-poses FILE.</source>
        <translation>neben den Messwerten steht keine Orientierung ({0}): Ergänzen Sie sie, oder geben Sie die Posen des Roboters als eigene Tabelle an, --robot-poses FILE.</translation>
    </message>
    <message>
        <source>there is no probe {0}: choose one of {1}.</source>
        <translation>die Sonde {0} gibt es nicht: Wählen Sie eine von diesen: {1}.</translation>
    </message>
    <message>
        <source>there is no region of rank {0}: there are {1}, numbered from 1.</source>
        <translation>es gibt keine Region mit dem Rang {0}: Vorhanden sind {1}, gezählt ab 1.</translation>
    </message>
    <message>
        <source>there is no region {0}: choose one of: {1}.</source>
        <translation>es gibt keine Region {0}: Wählen Sie eine von: {1}.</translation>
    </message>
    <message>
        <source>there is no robot named {0}; known: {1}, or a URDF or MJCF file</source>
        <translation>es gibt keinen Roboter namens {0}; bekannt: {1}, oder eine URDF- oder MJCF-Datei</translation>
    </message>
    <message>
        <source>there is no statistic {0}: choose one of {1}.</source>
        <translation>die Statistik {0} gibt es nicht: Wählen Sie eine von {1}.</translation>
    </message>
    <message>
        <source>there is no such file: check the path.</source>
        <translation>eine solche Datei gibt es nicht: den Pfad prüfen.</translation>
    </message>
    <message>
        <source>there is no surface within {0} mm of {1} mm.</source>
        <translation>im Umkreis von {0} mm um {1} mm gibt es keine Oberfläche.</translation>
    </message>
    <message>
        <source>there is no touchable region {0}; the probe has {1}: choose one, or --all.</source>
        <translation>Es gibt keine berührbare Region {0}; die Sonde hat {1}: eine wählen, oder --all.</translation>
    </message>
    <message>
        <source>there is nothing to keep</source>
        <translation>es gibt nichts zu behalten</translation>
    </message>
    <message>
        <source>these contacts have no confidence: locate them again for a column `confidence`, or turn off confidence weights.</source>
        <translation>diese Kontakte sagen nicht, wie sicher sie sind: Lokalisieren Sie sie neu, für eine Spalte `confidence`, oder gewichten Sie nicht nach Sicherheit.</translation>
    </message>
    <message>
        <source>these contacts have no times: give a recording, or a table with times.</source>
        <translation>diese Kontakte haben keine Zeiten: Geben Sie eine Aufzeichnung an, oder eine Tabelle mit Zeiten.</translation>
    </message>
    <message>
        <source>these regions are for a mesh of {0} facets, this one has {1}: transfer them from their mesh instead.</source>
        <translation>diese Regionen sind für ein Netz mit {0} Facetten, dieses hat {1}: Übertragen Sie sie stattdessen von ihrem Netz.</translation>
    </message>
    <message>
        <source>these regions have the format {0}, not {1}: use a newer contactbench.</source>
        <translation>diese Regionen haben das Format {0}, nicht {1}: Verwenden Sie ein neueres contactbench.</translation>
    </message>
    <message>
        <source>these touches do not tell whether that helps</source>
        <translation>diese Berührungen zeigen nicht, ob das hilft</translation>
    </message>
    <message>
        <source>they have more than one of comma, semicolon and tab: send decimal points, or name the separator with the option separator</source>
        <translation>sie enthalten mehr als eines von Komma, Semikolon und Tabulator: Senden Sie Dezimalpunkte, oder nennen Sie das Trennzeichen mit der Option separator</translation>
    </message>
    <message>
        <source>thin facet folds</source>
        <translation>dünne Facette faltet sich</translation>
    </message>
    <message>
        <source>thin facets fold</source>
        <translation>dünne Facetten falten sich</translation>
    </message>
    <message>
        <source>this JSON file contains no regions: choose a file that was exported as regions.</source>
        <translation>diese JSON-Datei enthält keine Regionen: eine Datei wählen, die als Regionen exportiert wurde.</translation>
    </message>
    <message>
        <source>this cannot be written to a journal ({0}): give finite numbers, texts or lists.</source>
        <translation>das lässt sich nicht in ein Journal schreiben ({0}): Geben Sie endliche Zahlen, Texte oder Listen an.</translation>
    </message>
    <message>
        <source>this file does not contain region steps, or has another version.</source>
        <translation>diese Datei enthält keine Schritte von Regionen, oder sie hat eine andere Version.</translation>
    </message>
    <message>
        <source>this is a binary OFF file, but only text is supported: save it as text, or as binary PLY.</source>
        <translation>das ist eine binäre OFF-Datei, und nur Text wird gelesen: als Text speichern, oder als binäres PLY.</translation>
    </message>
    <message>
        <source>this is a device or a pipe, not a file: choose a mesh file.</source>
        <translation>das ist ein Gerät oder eine Pipe, keine Datei: eine Netzdatei wählen.</translation>
    </message>
    <message>
        <source>this is a folder: choose a mesh file inside it.</source>
        <translation>das ist ein Ordner: eine Netzdatei darin wählen.</translation>
    </message>
    <message>
        <source>this is a recording ({0} rows, {1} apart), not a table of still poses: find the still poses with contactbench calibrate captures.</source>
        <translation>dies ist eine Aufzeichnung ({0} Zeilen im Abstand von {1}), keine Tabelle ruhiger Posen: Finden Sie die ruhigen Posen mit contactbench calibrate captures.</translation>
    </message>
    <message>
        <source>this is a {0} file: {1} {2}</source>
        <translation>das ist eine {0}-Datei: {1} {2}</translation>
    </message>
    <message>
        <source>this is not UTF-8 text: save the table as CSV (UTF-8).</source>
        <translation>das ist kein UTF-8-Text: Speichern Sie die Tabelle als CSV (UTF-8).</translation>
    </message>
    <message>
        <source>this is not a JSON file ({0}): copy or export it again.</source>
        <translation>das ist keine JSON-Datei ({0}): Kopieren oder exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>this is not a glTF file: it has no &apos;asset&apos;. Choose another, or export it again.</source>
        <translation>das ist keine glTF-Datei: Ihr fehlt &apos;asset&apos;. Wählen Sie eine andere, oder exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>this is not a readable 3MF archive ({0}): copy or export it again.</source>
        <translation>das ist kein lesbares 3MF-Archiv ({0}): Kopieren oder exportieren Sie es neu.</translation>
    </message>
    <message>
        <source>this kind of result cannot be computed here, so it was not compared.</source>
        <translation>diese Art von Ergebnis kann hier nicht berechnet werden und wurde nicht verglichen.</translation>
    </message>
    <message>
        <source>this session has no {0}{1}: add it with --kind {2}.</source>
        <translation>diese Sitzung enthält nichts dieser Art: {0}{1}. Fügen Sie es mit --kind {2} hinzu.</translation>
    </message>
    <message>
        <source>this stroke has ended: start another one.</source>
        <translation>dieser Strich ist beendet: Beginnen Sie einen neuen.</translation>
    </message>
    <message>
        <source>time in s and the flange pose in the robot&apos;s base as a quaternion; joints, in degrees, need ?robot=NAME</source>
        <translation>Zeit in s und die Pose des Flansches in der Roboterbasis als Quaternion; Gelenke, in Grad, brauchen ?robot=NAME</translation>
    </message>
    <message>
        <source>time in s, reference force in N</source>
        <translation>Zeit in s, Kraft der Referenz in N</translation>
    </message>
    <message>
        <source>time {0} s after {1} s: times must be finite and must not decrease; sort the samples, or start a new detector after the clock restarts</source>
        <translation>Zeit {0} s nach {1} s: Zeiten müssen endlich sein und dürfen nicht rückwärts laufen; sortieren Sie die Messwerte, oder beginnen Sie nach einem Neustart der Uhr mit einem neuen Detektor</translation>
    </message>
    <message>
        <source>time: not measured</source>
        <translation>Zeit: nicht gemessen</translation>
    </message>
    <message>
        <source>timed out</source>
        <translation>Zeit abgelaufen</translation>
    </message>
    <message>
        <source>times in column t</source>
        <translation>Zeiten in Spalte t</translation>
    </message>
    <message>
        <source>times: give one for each of the {0} samples, s, not shape {1}</source>
        <translation>times: Geben Sie eine für jeden der {0} Messwerte an, s, nicht die Form {1}</translation>
    </message>
    <message>
        <source>times: give one per sample, {0}, not shape {1}</source>
        <translation>times: eine Zeit pro Messwert angeben, {0}, nicht die Form {1}</translation>
    </message>
    <message>
        <source>times: size of the probe relative to its mesh.</source>
        <translation>mal: Größe der Sonde durch die ihres Netzes.</translation>
    </message>
    <message>
        <source>times[{0}] is {1} s{2}: times must be finite and increase; sort the samples or drop those with a repeated time</source>
        <translation>times[{0}] ist {1} s{2}: Zeiten müssen endlich sein und zunehmen; die Messwerte sortieren oder die mit doppelter Zeit weglassen</translation>
    </message>
    <message>
        <source>tissue {0}: give positive numbers; damping and friction may be 0.</source>
        <translation>Gewebe {0}: Geben Sie positive Zahlen an; Dämpfung und Reibung dürfen 0 sein.</translation>
    </message>
    <message>
        <source>tissue: a cylinder of {0} m, {1} rad askew: give at least 0.02 m, a finite angle.</source>
        <translation>tissue: ein Zylinder von {0} m, um {1} rad gedreht: Geben Sie mindestens 0.02 m und einen endlichen Winkel an.</translation>
    </message>
    <message>
        <source>tissue: course of times {0} and factors {1}: give as many of both, times that grow, s, and factors above 0.</source>
        <translation>tissue: Verlauf mit Zeiten {0} und Faktoren {1}: von beiden gleich viele angeben, wachsende Zeiten, s, und Faktoren über 0.</translation>
    </message>
    <message>
        <source>to_pose: the capture at {0} s has no orientation: give R_WS</source>
        <translation>to_pose: Die Aufnahme bei {0} s hat keine Orientierung: Geben Sie R_WS an</translation>
    </message>
    <message>
        <source>too few accepted touches of {0}{1}</source>
        <translation>zu wenige gezählte Berührungen: {0}{1}</translation>
    </message>
    <message>
        <source>too few to judge the whole probe: {0} touched, at least {1} are needed</source>
        <translation>zu wenige, um über die ganze Sonde zu urteilen: {0} berührt, mindestens nötig sind {1}</translation>
    </message>
    <message>
        <source>too little force to locate</source>
        <translation>zu wenig Kraft zum Lokalisieren</translation>
    </message>
    <message>
        <source>too short</source>
        <translation>zu kurz</translation>
    </message>
    <message>
        <source>tool on the other side of the sensor</source>
        <translation>Werkzeug auf der anderen Seite des Sensors</translation>
    </message>
    <message>
        <source>tool {0}: give six finite numbers, m and rad.</source>
        <translation>Werkzeug {0}: sechs endliche Zahlen angeben, m und rad.</translation>
    </message>
    <message>
        <source>torque {0} sigma ({1} mN·m) off</source>
        <translation>Moment {0} Sigma ({1} mN·m) daneben</translation>
    </message>
    <message>
        <source>torques</source>
        <translation>Momente</translation>
    </message>
    <message>
        <source>torques 1000 times too small</source>
        <translation>Momente 1000-mal zu klein</translation>
    </message>
    <message>
        <source>touch in a second orientation, or on other sides.</source>
        <translation>berühren Sie in einer zweiten Orientierung oder auf anderen Seiten.</translation>
    </message>
    <message>
        <source>touch more markers, from other angles and in other orientations.</source>
        <translation>berühren Sie mehr Marker, aus anderen Winkeln und in anderen Orientierungen.</translation>
    </message>
    <message>
        <source>touch protocol: give at least one force window, 4 to 100,000 samples and 1 to 1000 repeats.</source>
        <translation>Berührungsprotokoll: Geben Sie mindestens ein Kraftfenster, 4 bis 100,000 Messwerte und 1 bis 1000 Wiederholungen an.</translation>
    </message>
    <message>
        <source>touch protocol: {0} {1}: give a positive number.</source>
        <translation>Berührungsprotokoll: {0} {1}: Geben Sie eine positive Zahl an.</translation>
    </message>
    <message>
        <source>touch, streams, self_test, gates or regions: fields of version 3</source>
        <translation>touch, streams, self_test, gates oder regions: Felder der Version 3</translation>
    </message>
    <message>
        <source>touch.model_error: a bundle stores no covariance for it: leave extra out.</source>
        <translation>touch.model_error: Ein Bundle enthält keine Kovarianz davon: extra weglassen.</translation>
    </message>
    <message>
        <source>touch: give either marker (a number from 1) or point_S (three lengths, m).</source>
        <translation>touch: Geben Sie entweder marker (eine Zahl ab 1) oder point_S (drei Längen, m) an.</translation>
    </message>
    <message>
        <source>touch: marker {0}: give a whole number from 1.</source>
        <translation>touch: marker {0}: Geben Sie eine ganze Zahl ab 1 an.</translation>
    </message>
    <message>
        <source>touch: the wrist turns until {0} s: touch after that.</source>
        <translation>touch: Das Handgelenk dreht sich bis {0} s: Berühren Sie danach.</translation>
    </message>
    <message>
        <source>touch: there is no marker {0}: choose 1 to {1}.</source>
        <translation>touch: Marker {0}: Es gibt 1 bis {1}.</translation>
    </message>
    <message>
        <source>toward_P points along the axis, so it does not fix the turn about it: pick a point to the side.</source>
        <translation>toward_P zeigt entlang der Achse und legt die Drehung um sie nicht fest: Wählen Sie einen Punkt seitlich davon.</translation>
    </message>
    <message>
        <source>travel: shapes {0} and {1} do not broadcast</source>
        <translation>travel: Die Formen {0} und {1} passen nicht zusammen</translation>
    </message>
    <message>
        <source>try again</source>
        <translation>noch einmal versuchen</translation>
    </message>
    <message>
        <source>tuning: gain margin {0}, phase margin {1} degrees: give 1 to 100, and 0 to 90.</source>
        <translation>Abstimmung: Amplitudenreserve {0}, Phasenreserve {1} Grad: 1 bis 100 angeben, und 0 bis 90.</translation>
    </message>
    <message>
        <source>tuning: spread {0}, fastest {1}/s: give 1 to 20, and up to 50.</source>
        <translation>Abstimmung: Streubreite {0}, schnellste {1}/s: 1 bis 20 angeben, und bis 50.</translation>
    </message>
    <message>
        <source>tuning: {0}: even a gain of {1}/s leaves less than the wanted margins: lower the margins or the spread of stiffness.</source>
        <translation>Abstimmung: {0}: Selbst eine Verstärkung von {1}/s lässt weniger als die gewünschten Reserven: weniger verlangen, oder eine kleinere Streubreite der Steifigkeit.</translation>
    </message>
    <message>
        <source>turn by it</source>
        <translation>danach drehen</translation>
    </message>
    <message>
        <source>turn by what is near the last sure place</source>
        <translation>nach dem drehen, was nahe der letzten sicheren Stelle liegt</translation>
    </message>
    <message>
        <source>turn_to: R_WS is not a rotation: its rows must be right-handed unit vectors.</source>
        <translation>turn_to: R_WS ist keine Drehung: Die Zeilen müssen Einheitsvektoren eines Rechtssystems sein.</translation>
    </message>
    <message>
        <source>turn_to: give either rpy (three angles in degrees) or R_WS.</source>
        <translation>turn_to: Geben Sie entweder rpy (drei Winkel in Grad) oder R_WS an.</translation>
    </message>
    <message>
        <source>turned by the matrix given</source>
        <translation>mit der angegebenen Matrix gedreht</translation>
    </message>
    <message>
        <source>turned by {0}° about the flange&apos;s z axis</source>
        <translation>um {0}° um die z-Achse des Flanschs gedreht</translation>
    </message>
    <message>
        <source>turned by {0}°, {1}° and {2}° about the fixed axes x, y and z</source>
        <translation>um {0}°, {1}° und {2}° um die festen Achsen x, y und z gedreht</translation>
    </message>
    <message>
        <source>two files of one input have the same name</source>
        <translation>zwei Dateien einer Eingabe haben denselben Namen</translation>
    </message>
    <message>
        <source>two regions are called {0}: rename one.</source>
        <translation>zwei Regionen heißen {0}: Benennen Sie eine um.</translation>
    </message>
    <message>
        <source>two rows are swapped</source>
        <translation>zwei Zeilen vertauscht sind</translation>
    </message>
    <message>
        <source>uncertainty (1 sigma)</source>
        <translation>Unsicherheit (1 Sigma)</translation>
    </message>
    <message>
        <source>unchanged they leave {0}, and no other reading is more probable</source>
        <translation>unverändert bleiben {0}, und keine andere Lesart ist wahrscheinlicher</translation>
    </message>
    <message>
        <source>units={0} is not known: pass one of &apos;m&apos;, &apos;cm&apos;, &apos;mm&apos;, &apos;in&apos;, &apos;auto&apos;.</source>
        <translation>units={0} ist nicht bekannt: eines davon übergeben: &apos;m&apos;, &apos;cm&apos;, &apos;mm&apos;, &apos;in&apos;, &apos;auto&apos;.</translation>
    </message>
    <message>
        <source>unknown device {0}. Known: {1}.</source>
        <translation>unbekanntes Gerät {0}. Bekannt: {1}.</translation>
    </message>
    <message>
        <source>unknown option {0}. Possible: {1}</source>
        <translation>unbekannte Option {0}. Möglich: {1}</translation>
    </message>
    <message>
        <source>use the file as contactbench wrote it, or calibrate again.</source>
        <translation>Verwenden Sie die Datei so, wie contactbench sie geschrieben hat, oder kalibrieren Sie neu.</translation>
    </message>
    <message>
        <source>use the file that contactbench wrote, or align again.</source>
        <translation>Verwenden Sie die Datei so, wie contactbench sie geschrieben hat, oder richten Sie neu aus.</translation>
    </message>
    <message>
        <source>user name: devices do not use one: leave out the part before the @</source>
        <translation>Benutzername: Geräte verwenden keinen: den Teil vor dem @ weglassen</translation>
    </message>
    <message>
        <source>uses a vertex twice</source>
        <translation>nutzt einen Eckpunkt zweimal</translation>
    </message>
    <message>
        <source>verification</source>
        <translation>Überprüfung</translation>
    </message>
    <message>
        <source>verify again</source>
        <translation>erneut prüfen</translation>
    </message>
    <message>
        <source>verify again with the mounting of the calibration</source>
        <translation>erneut prüfen, mit der Montage der Kalibrierung</translation>
    </message>
    <message>
        <source>verify again with this contactbench</source>
        <translation>mit diesem contactbench neu verifizieren</translation>
    </message>
    <message>
        <source>verify_still: no poses; take three or more, in other orientations than before</source>
        <translation>verify_still: keine Posen; mindestens drei aufnehmen, in anderen Orientierungen als zuvor</translation>
    </message>
    <message>
        <source>verify_still: {0} was used for the calibration; give poses that were not used</source>
        <translation>verify_still: {0} wurde für die Kalibrierung benutzt; Posen angeben, die nicht dafür benutzt wurden</translation>
    </message>
    <message>
        <source>vertex</source>
        <translation>Eckpunkt</translation>
    </message>
    <message>
        <source>vertex {0} is ({1}); {2} not finite. Repair the file or export it again.</source>
        <translation>Eckpunkt {0} ist ({1}); {2} nicht endlich. Reparieren Sie die Datei, oder exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>vertices</source>
        <translation>Eckpunkte</translation>
    </message>
    <message>
        <source>vertices must be real numbers in metres, not {0}: convert them to float64.</source>
        <translation>vertices müssen reelle Zahlen in Metern sein, nicht {0}: in float64 umwandeln.</translation>
    </message>
    <message>
        <source>vertices must have shape (n, 3), not {0}: give one x, y, z row per vertex.</source>
        <translation>vertices müssen die Form (n, 3) haben, nicht {0}: eine Zeile x, y, z pro Eckpunkt angeben.</translation>
    </message>
    <message>
        <source>vertices: row {0} ({1}) {2}; {3} of {4} rows are. Repair or export the mesh again.</source>
        <translation>vertices: Zeile {0} ({1}) {2}; betroffen sind {3} von {4} Zeilen. Das Netz reparieren oder neu exportieren.</translation>
    </message>
    <message>
        <source>virtual bench</source>
        <translation>virtueller Messplatz</translation>
    </message>
    <message>
        <source>virtual bench: no script was given.</source>
        <translation>virtueller Messplatz: Es gibt kein Skript: Nichts würde geschehen.</translation>
    </message>
    <message>
        <source>virtual bench: seed {0}: give a whole number of 0 or more.</source>
        <translation>virtueller Messplatz: Startwert {0}: Geben Sie eine ganze Zahl ab 0 an.</translation>
    </message>
    <message>
        <source>virtual bench: the mounting R_SE is not a rotation: give three rows of three numbers.</source>
        <translation>virtueller Messplatz: Die Montage R_SE ist keine Drehung: Geben Sie drei Zeilen mit je drei Zahlen an.</translation>
    </message>
    <message>
        <source>virtual bench: {0} {1} Hz: give one above 0, up to {2}.</source>
        <translation>virtueller Messplatz: {0} {1} Hz: Geben Sie einen Wert über 0 und bis {2} an.</translation>
    </message>
    <message>
        <source>warm: {0} K: give at most 100 K either way.</source>
        <translation>warm: {0} K: Geben Sie höchstens 100 K nach oben oder unten an.</translation>
    </message>
    <message>
        <source>was abandoned, with {0} samples</source>
        <translation>wurde abgebrochen, Zahl der Messwerte: {0}</translation>
    </message>
    <message>
        <source>was located {0} mm off</source>
        <translation>wurde {0} mm daneben gefunden</translation>
    </message>
    <message>
        <source>was not located at all</source>
        <translation>wurde gar nicht gefunden</translation>
    </message>
    <message>
        <source>weight or offset is still in the wrenches ({0} N, repeatedly)</source>
        <translation>Gewicht oder Nullpunkt steckt noch in den Messwerten ({0} N, immer wieder gelesen)</translation>
    </message>
    <message>
        <source>weights: none may be negative, and at least one must be above 0.</source>
        <translation>weights: keines darf negativ sein, und einige müssen über 0 liegen.</translation>
    </message>
    <message>
        <source>what the tissue does to the probe, about the origin of S</source>
        <translation>was das Gewebe auf die Sonde ausübt, um den Ursprung von S</translation>
    </message>
    <message>
        <source>whether contacts were verified</source>
        <translation>ob Kontakte überprüft sind</translation>
    </message>
    <message>
        <source>whether sign, units and scale were checked with a known weight or touch</source>
        <translation>ob Vorzeichen, Einheiten und Skala mit einem bekannten Gewicht oder Druckpunkt geprüft wurden</translation>
    </message>
    <message>
        <source>which miss the limit, but more facets hardly help because the surface itself is rough</source>
        <translation>die die Grenze verfehlen, doch mehr Facetten helfen kaum, weil die Fläche selbst rau ist</translation>
    </message>
    <message>
        <source>which touches get an answer</source>
        <translation>welche Berührungen beantwortet werden</translation>
    </message>
    <message>
        <source>whole part</source>
        <translation>ganzes Teil</translation>
    </message>
    <message>
        <source>whole parts</source>
        <translation>ganze Teile</translation>
    </message>
    <message>
        <source>with {0} N or more</source>
        <translation>mit {0} N oder mehr</translation>
    </message>
    <message>
        <source>with {0} the residuals fall from {1} to {2}</source>
        <translation>die Restabweichungen fallen von {1} auf {2} (Lesart: {0})</translation>
    </message>
    <message>
        <source>with {0} the residuals rise to the noise&apos;s size, from {1} to {2}</source>
        <translation>die Restabweichungen steigen von {1} auf {2}, die Größe des Rauschens (Lesart: {0})</translation>
    </message>
    <message>
        <source>with {0} {1}</source>
        <translation>mit {0} {1}</translation>
    </message>
    <message>
        <source>withdrawn: it scattered by {0}, more than the still sensor does</source>
        <translation>zurückgezogen: Sie streute um {0}, mehr als der ruhige Sensor</translation>
    </message>
    <message>
        <source>within {0} mm of the original</source>
        <translation>innerhalb von {0} mm des Originals</translation>
    </message>
    <message>
        <source>world, zero, checks or noise.orientation_rad: fields of version 4</source>
        <translation>world, zero, checks oder noise.orientation_rad: Felder der Version 4</translation>
    </message>
    <message>
        <source>wrench: give six numbers, force before torque, not shape {0}</source>
        <translation>wrench: Geben Sie sechs Zahlen an, Kraft vor Moment, nicht die Form {0}</translation>
    </message>
    <message>
        <source>wrenches: give rows of six numbers, force before torque, not shape {0}</source>
        <translation>wrenches: Geben Sie Zeilen aus sechs Zahlen an, Kraft vor Moment, nicht die Form {0}</translation>
    </message>
    <message>
        <source>write the number of a facet or region.</source>
        <translation>die Nummer einer Facette oder Region schreiben.</translation>
    </message>
    <message>
        <source>yaml_number: {0} is not finite; a consumer would act on it</source>
        <translation>yaml_number: {0} ist nicht endlich; ein Empfänger würde danach handeln</translation>
    </message>
    <message>
        <source>{0} % of the samples are spikes: check plug and cable</source>
        <translation>{0} % der Messwerte sind Ausreißer: Prüfen Sie Stecker und Kabel</translation>
    </message>
    <message>
        <source>{0} % of the settled touches are lost, doubtful or jump, more than {1} %</source>
        <translation>{0} % der eindeutig georteten Berührungen sind verloren, zweifelhaft oder springen, mehr als {1} %</translation>
    </message>
    <message>
        <source>{0} (allowed: {1} %)</source>
        <translation>{0} (erlaubt: {1} %)</translation>
    </message>
    <message>
        <source>{0} (allowed: {1} mm)</source>
        <translation>{0} (erlaubt: {1} mm)</translation>
    </message>
    <message>
        <source>{0} (possibly, at odds of {1})</source>
        <translation>{0} (möglich, Chancen {1})</translation>
    </message>
    <message>
        <source>{0} (probably, at odds of {1})</source>
        <translation>{0} (wahrscheinlich, Chancen {1})</translation>
    </message>
    <message>
        <source>{0} ({1} kg)</source>
        <translation>{0} ({1} kg)</translation>
    </message>
    <message>
        <source>{0} ({1} of {2})</source>
        <translation>{0} ({1} von {2})</translation>
    </message>
    <message>
        <source>{0} ({1} to {2} N)</source>
        <translation>{0} ({1} bis {2} N)</translation>
    </message>
    <message>
        <source>{0} ({1}) are slivers with an angle under 1°; the worst is {2} times longer than high. They are common in CAD exports, make normals uncertain and simplification worse.</source>
        <translation>Splitter mit einem Winkel unter 1°: {0} ({1}); der schlimmste ist {2}-mal so lang wie hoch. Sie sind in CAD-Exporten häufig; sie machen Normalen unsicher und die Vereinfachung schlechter.</translation>
    </message>
    <message>
        <source>{0} Calibrate again.</source>
        <translation>{0} Kalibrieren Sie neu.</translation>
    </message>
    <message>
        <source>{0} Check that the weight hangs freely, and that the sensor&apos;s own calibration and range are correct. If they are, multiply its forces and torques by {1}.</source>
        <translation>{0} Prüfen, ob das Gewicht frei hängt und ob die eigene Kalibrierung und der Messbereich des Sensors die richtigen sind. Falls ja, seine Kräfte und Drehmomente mit {1} multiplizieren.</translation>
    </message>
    <message>
        <source>{0} Everything recorded until then is safe.</source>
        <translation>{0} Alles bis dahin Aufgezeichnete ist sicher.</translation>
    </message>
    <message>
        <source>{0} Give the local gravity, or allow a larger limit.</source>
        <translation>{0} Die örtliche Fallbeschleunigung angeben oder eine größere Grenze zulassen.</translation>
    </message>
    <message>
        <source>{0} Hz instead of {1} Hz</source>
        <translation>{0} Hz statt {1} Hz</translation>
    </message>
    <message>
        <source>{0} Ignore this if it is still being recorded.</source>
        <translation>{0} Das gilt nicht, falls sie gerade läuft.</translation>
    </message>
    <message>
        <source>{0} N and {1} mN·m</source>
        <translation>{0} N und {1} mN·m</translation>
    </message>
    <message>
        <source>{0} N and {1} mN·m more than the load explains</source>
        <translation>{0} N und {1} mN·m mehr, als die Last erklärt</translation>
    </message>
    <message>
        <source>{0} Pick a point on the tip to be sure.</source>
        <translation>{0} Wählen Sie einen Punkt auf der Spitze, um sicher zu sein.</translation>
    </message>
    <message>
        <source>{0} Prepare it again.</source>
        <translation>{0} Bereiten Sie sie neu vor.</translation>
    </message>
    <message>
        <source>{0} Repeat it.</source>
        <translation>{0} Wiederholen Sie es.</translation>
    </message>
    <message>
        <source>{0} Repeat that, then export again.</source>
        <translation>{0} Wiederholen Sie das, dann exportieren Sie erneut.</translation>
    </message>
    <message>
        <source>{0} The delay is not applied. To apply it anyway, give it: --delay {1}.</source>
        <translation>{0} Der Verzug wird nicht angewandt. Um ihn trotzdem anzuwenden, geben Sie ihn an: --delay {1}.</translation>
    </message>
    <message>
        <source>{0} Use a weight known to better than {1} %.</source>
        <translation>{0} Ein Gewicht verwenden, das genauer als auf {1} % bekannt ist.</translation>
    </message>
    <message>
        <source>{0} Use a weight of {1} kg or more, hold still for longer, or take {2} readings with and without the weight.</source>
        <translation>{0} Ein Gewicht von mindestens {1} kg verwenden, länger still halten oder je {2} Messungen mit und ohne Gewicht machen.</translation>
    </message>
    <message>
        <source>{0} Verify again.</source>
        <translation>{0} Prüfen Sie erneut.</translation>
    </message>
    <message>
        <source>{0} Within 3 sigma this may be zero, so no delay is applied.</source>
        <translation>{0} Innerhalb von 3 Sigma kann das null sein: Es wird kein Verzug angewendet.</translation>
    </message>
    <message>
        <source>{0} after {1} s of averaging; {2} s are needed</source>
        <translation>{0}, nach {1} s Mittelung; nötig sind {2} s</translation>
    </message>
    <message>
        <source>{0} along the base&apos;s axes</source>
        <translation>{0} entlang der Achsen der Basis</translation>
    </message>
    <message>
        <source>{0} along {1} by {2} mm{3}</source>
        <translation>{0} entlang {1} um {2} mm{3}</translation>
    </message>
    <message>
        <source>{0} and {1}</source>
        <translation>{0} und {1}</translation>
    </message>
    <message>
        <source>{0} answers of the robot were dropped because they took longer than {1} ms; the last took {2} ms: check network and controller, or choose a lower rate.</source>
        <translation>{0} Antworten des Roboters wurden verworfen, weil sie länger als {1} ms brauchten; die letzte brauchte {2} ms: Netzwerk und Steuerung prüfen oder eine niedrigere Rate wählen.</translation>
    </message>
    <message>
        <source>{0} appears twice</source>
        <translation>{0} kommt zweimal vor</translation>
    </message>
    <message>
        <source>{0} at {1} {2}</source>
        <translation>{0} bei {1} {2}</translation>
    </message>
    <message>
        <source>{0} axis reversed</source>
        <translation>{0}-Achse umgekehrt</translation>
    </message>
    <message>
        <source>{0} back onto a neighbour. Contacts there are missed or found on the far side. </source>
        <translation>Facetten, die auf einen Nachbarn zurückgefaltet sind: {0}. Kontakte dort werden übersehen oder auf der Gegenseite gefunden. </translation>
    </message>
    <message>
        <source>{0} back to back with another that has the same corners: a doubled surface or sheet that shows its front on both sides, or parts that touch. A force meets two surfaces at once. {1}</source>
        <translation>Rücken an Rücken mit anderen, die dieselben Ecken haben: {0}; das ist eine doppelte Oberfläche oder ein Blatt, das auf beiden Seiten seine Vorderseite zeigt, oder Teile berühren sich. Eine Kraft trifft zwei Oberflächen zugleich. {1}</translation>
    </message>
    <message>
        <source>{0} belongs to another verification: create the report again.</source>
        <translation>{0} gehört zu einer anderen Überprüfung: den Bericht neu erstellen.</translation>
    </message>
    <message>
        <source>{0} by {1}</source>
        <translation>{0} mit {1}</translation>
    </message>
    <message>
        <source>{0} bytes are too few for an STL file: it is cut short or is something else.</source>
        <translation>{0} Bytes sind zu wenig für eine STL-Datei: Sie ist abgeschnitten oder etwas anderes.</translation>
    </message>
    <message>
        <source>{0} bytes of the answer are missing</source>
        <translation>{0} Bytes der Antwort fehlen</translation>
    </message>
    <message>
        <source>{0} bytes received, but no frame in them: check the device type and the line speed.</source>
        <translation>{0} Bytes empfangen, aber kein Frame darin: die Art des Geräts und die Geschwindigkeit der Leitung prüfen.</translation>
    </message>
    <message>
        <source>{0} cannot be loaded ({1}): {2}.</source>
        <translation>{0} lässt sich nicht laden ({1}): {2}.</translation>
    </message>
    <message>
        <source>{0} cannot be read ({1})</source>
        <translation>{0} kann nicht gelesen werden ({1})</translation>
    </message>
    <message>
        <source>{0} cannot be read as an array of {1}: {2}</source>
        <translation>{0} kann nicht als Array gelesen werden (Inhalt: {1}): {2}</translation>
    </message>
    <message>
        <source>{0} cannot be started ({1}): check that {2} can be run.</source>
        <translation>{0} kann nicht gestartet werden ({1}): prüfen, ob {2} ausgeführt werden kann.</translation>
    </message>
    <message>
        <source>{0} cell{1}, but the header has {2}</source>
        <translation>Zellen in dieser Zeile des CSV{1}: {0}, in der Kopfzeile aber: {2}</translation>
    </message>
    <message>
        <source>{0} closings were given, but the mesh has {1} openings: leave out the rest.</source>
        <translation>{0} Arten des Schließens sind angegeben, aber das Netz hat {1} Öffnungen: Lassen Sie die übrigen weg.</translation>
    </message>
    <message>
        <source>{0} contradict each other: give only one.</source>
        <translation>{0} widersprechen einander: Geben Sie eines an.</translation>
    </message>
    <message>
        <source>{0} converted as {1}</source>
        <translation>{0} umgerechnet als {1}</translation>
    </message>
    <message>
        <source>{0} did not report which original facets its facets come from: use another mesh.</source>
        <translation>{0} hat nicht gemeldet, aus welchen Facetten seine Facetten stammen: ein anderes Netz nehmen.</translation>
    </message>
    <message>
        <source>{0} documents {1}, but has no such parameter</source>
        <translation>{0} dokumentiert {1}, hat aber keinen solchen Parameter</translation>
    </message>
    <message>
        <source>{0} facets are too few: no closed surface has fewer than {1}.</source>
        <translation>{0} Facetten sind zu wenige: Keine geschlossene Oberfläche hat weniger als {1}.</translation>
    </message>
    <message>
        <source>{0} facets are up to {1} off: the shape is lost.</source>
        <translation>{0} Facetten weichen um bis zu {1} ab: Die Form geht verloren.</translation>
    </message>
    <message>
        <source>{0} facets asked for: {1}</source>
        <translation>{0} Facetten verlangt: {1}</translation>
    </message>
    <message>
        <source>{0} facets asked for: {1} facets, {2}.</source>
        <translation>{0} Facetten verlangt: {1} Facetten, {2}.</translation>
    </message>
    <message>
        <source>{0} facets lie within {1} mm of the touch: simplify the true surface to facets of half a millimetre.</source>
        <translation>{0} Facetten liegen innerhalb von {1} mm um die Berührung: Vereinfachen Sie die wahre Oberfläche auf Facetten von einem halben Millimeter.</translation>
    </message>
    <message>
        <source>{0} facets{1}: {2}.</source>
        <translation>{0} Facetten{1}: {2}.</translation>
    </message>
    <message>
        <source>{0} files belong to no record, such as {1}: left by a crash before their record was written.</source>
        <translation>{0} Dateien gehören zu keinem Eintrag, etwa {1}: Reste eines Absturzes, bevor der Eintrag geschrieben war.</translation>
    </message>
    <message>
        <source>{0} from the prediction of the other poses: bumped, touched, or captured while moving.</source>
        <translation>{0}, gegenüber der Vorhersage der anderen Posen: angestoßen, berührt oder in Bewegung aufgenommen.</translation>
    </message>
    <message>
        <source>{0} gives no poses: give the address of a robot, such as ur+tcp://192.168.0.10.</source>
        <translation>{0} liefert keine Posen: Geben Sie die Adresse eines Roboters an, etwa ur+tcp://192.168.0.10.</translation>
    </message>
    <message>
        <source>{0} hangs on {1}, and no transform leads from {2} to {3}.</source>
        <translation>{0} hängt an {1}, und keine Transformation führt von {2} zu {3}.</translation>
    </message>
    <message>
        <source>{0} hangs on {1}: give --base and --flange the other way round.</source>
        <translation>{0} hängt an {1}: Geben Sie --base und --flange umgekehrt an.</translation>
    </message>
    <message>
        <source>{0} has a rim that crosses itself and cannot be closed automatically: close it in the CAD program, or leave it open (closing &apos;open&apos;).</source>
        <translation>{0} hat einen Rand, der sich selbst kreuzt, und kann nicht automatisch geschlossen werden: Schließen Sie das Netz dort im CAD-Programm, oder lassen Sie es offen (closing &apos;open&apos;).</translation>
    </message>
    <message>
        <source>{0} has no time zone: use datetime.now(UTC).</source>
        <translation>{0} hat keine Zeitzone: Verwenden Sie datetime.now(UTC).</translation>
    </message>
    <message>
        <source>{0} has the number {1}, whose comma may be a decimal point or a thousands separator: export the file again with decimal points.</source>
        <translation>{0} enthält die Zahl {1}, deren Komma Dezimal- oder Tausendertrennzeichen sein kann: Exportieren Sie die Datei mit Dezimalpunkten neu.</translation>
    </message>
    <message>
        <source>{0} has {1} bytes, not {2}</source>
        <translation>{0} hat {1} Byte, nicht {2}</translation>
    </message>
    <message>
        <source>{0} has {1} bytes: each body takes {2}.</source>
        <translation>{0} hat {1} Bytes: Jeder Körper braucht {2}.</translation>
    </message>
    <message>
        <source>{0} has {1} rows, {2} {3}: give the wrenches that these contacts were located from.</source>
        <translation>{0} hat {1} Zeilen, {2} {3}: die Kräfte und Momente angeben, aus denen diese Kontakte bestimmt wurden.</translation>
    </message>
    <message>
        <source>{0} if they are {1}</source>
        <translation>{0}, wenn die Einheit {1} ist</translation>
    </message>
    <message>
        <source>{0} in the file were double or unused and have been merged or left out.</source>
        <translation>In der Datei doppelt oder ungenutzt, deshalb zusammengefasst oder ausgelassen: {0}.</translation>
    </message>
    <message>
        <source>{0} in {1}</source>
        <translation>{0} in {1}</translation>
    </message>
    <message>
        <source>{0} inside the body. They cannot be touched, but a line of force can hit them. {1}</source>
        <translation>Im Inneren des Körpers: {0}. Sie können nicht berührt werden, aber die Wirkungslinie einer Kraft kann sie treffen. {1}</translation>
    </message>
    <message>
        <source>{0} is a probe</source>
        <translation>{0} passt zu einer Sonde</translation>
    </message>
    <message>
        <source>{0} is a recording, not a table of still poses: add it with --kind recording, and compute captures from it first.</source>
        <translation>{0} ist eine Aufzeichnung, keine Tabelle ruhiger Posen: Fügen Sie sie mit --kind recording hinzu, und berechnen Sie zuerst captures daraus.</translation>
    </message>
    <message>
        <source>{0} is a recording: {1} still poses found in {2} readings.</source>
        <translation>{0} ist eine Aufzeichnung: {1} ruhige Posen gefunden in {2} Messwerten.</translation>
    </message>
    <message>
        <source>{0} is damaged: its checksum is wrong</source>
        <translation>{0} ist beschädigt: Die Prüfsumme stimmt nicht</translation>
    </message>
    <message>
        <source>{0} is impossible</source>
        <translation>{0} ist unmöglich</translation>
    </message>
    <message>
        <source>{0} is large for a probe</source>
        <translation>{0} ist groß für eine Sonde</translation>
    </message>
    <message>
        <source>{0} is missing</source>
        <translation>{0} fehlt</translation>
    </message>
    <message>
        <source>{0} is negative: a standard deviation is at least 0</source>
        <translation>{0} ist negativ: Eine Standardabweichung ist mindestens 0</translation>
    </message>
    <message>
        <source>{0} is no count</source>
        <translation>{0} ist keine Anzahl</translation>
    </message>
    <message>
        <source>{0} is not a force/torque sensor: give the address of a sensor, such as sri+tcp://192.168.0.108.</source>
        <translation>{0} ist kein Kraft-Momenten-Sensor: Geben Sie die Adresse eines Sensors an, etwa sri+tcp://192.168.0.108.</translation>
    </message>
    <message>
        <source>{0} is not a regular file</source>
        <translation>{0} ist keine gewöhnliche Datei</translation>
    </message>
    <message>
        <source>{0} is not a valid JSON number: export the file again.</source>
        <translation>{0} ist keine gültige JSON-Zahl: die Datei neu exportieren.</translation>
    </message>
    <message>
        <source>{0} is not a valid distance: give 1 to {1} rings, or a length above 0.</source>
        <translation>{0} ist keine Weite: Geben Sie 1 bis {1} Ringe an, oder eine Länge über 0.</translation>
    </message>
    <message>
        <source>{0} is not an order of {1} regions: name every rank once.</source>
        <translation>{0} ist keine Reihenfolge von {1} Regionen: Nennen Sie jeden Rang einmal.</translation>
    </message>
    <message>
        <source>{0} is not three numbers ({1}): give x, y and z.</source>
        <translation>{0} ist nicht drei Zahlen ({1}): Geben Sie x, y und z an.</translation>
    </message>
    <message>
        <source>{0} is small for a probe</source>
        <translation>{0} ist klein für eine Sonde</translation>
    </message>
    <message>
        <source>{0} is unknown</source>
        <translation>{0} ist unbekannt</translation>
    </message>
    <message>
        <source>{0} is unknown: choose from {1}</source>
        <translation>{0} ist unbekannt: Wählen Sie aus {1}</translation>
    </message>
    <message>
        <source>{0} is {1} {2}: give finite numbers below {3} {4}</source>
        <translation>{0} ist {1} {2}: Geben Sie endliche Zahlen unter {3} {4} an</translation>
    </message>
    <message>
        <source>{0} is {1}: give a finite number, or leave it out</source>
        <translation>{0} ist {1}: Geben Sie eine endliche Zahl an, oder lassen Sie es weg</translation>
    </message>
    <message>
        <source>{0} is {1}: give a length above 0.</source>
        <translation>{0} ist {1}: eine Länge über 0 angeben.</translation>
    </message>
    <message>
        <source>{0} is {1}: give a number above 0.</source>
        <translation>{0} ist {1}: Geben Sie eine Zahl über 0 an.</translation>
    </message>
    <message>
        <source>{0} is {1}: give a positive number, {2}.</source>
        <translation>{0} ist {1}: eine positive Zahl angeben, {2}.</translation>
    </message>
    <message>
        <source>{0} is {1}: give three numbers x, y and z.</source>
        <translation>{0} ist {1}: Geben Sie drei Zahlen x, y und z an.</translation>
    </message>
    <message>
        <source>{0} it was computed from was replaced by {1} on {2}.</source>
        <translation>{0}, woraus es berechnet wurde, wurde am {2} durch {1} ersetzt.</translation>
    </message>
    <message>
        <source>{0} lie exactly on another but are not merged, so the surface falls apart there. Save the mesh to a file and read it again to merge them.</source>
        <translation>Genau auf anderen und nicht zusammengefasst: {0}; dort fällt die Oberfläche auseinander. Speichern Sie das Netz in eine Datei und lesen Sie sie neu; das fasst zusammen.</translation>
    </message>
    <message>
        <source>{0} look bumped and were left out.</source>
        <translation>{0} wirken angestoßen und wurden ausgelassen.</translation>
    </message>
    <message>
        <source>{0} looks bumped{1} and was left out.</source>
        <translation>{0} wirkt angestoßen{1} und wurde ausgelassen.</translation>
    </message>
    <message>
        <source>{0} markers are too few: give at least {1}.</source>
        <translation>{0} Marker sind zu wenige: Verlangen Sie mindestens {1}.</translation>
    </message>
    <message>
        <source>{0} markers were</source>
        <translation>{0} Marker wurden</translation>
    </message>
    <message>
        <source>{0} markers: give a number from 1 to {1}.</source>
        <translation>{0} Marker: Geben Sie eine Zahl von 1 bis {1} an.</translation>
    </message>
    <message>
        <source>{0} mm on average, {1} mm at most</source>
        <translation>im Mittel {0} mm, höchstens {1} mm</translation>
    </message>
    <message>
        <source>{0} mm on average, {1} mm at most, on {2} markers</source>
        <translation>im Mittel {0} mm, höchstens {1} mm, Zahl der Marker: {2}</translation>
    </message>
    <message>
        <source>{0} mm rms (median {1})</source>
        <translation>{0} mm rms (Median {1})</translation>
    </message>
    <message>
        <source>{0} mm² ({1} %) of the shell is invented: contacts there rest on a guess. If that area will be touched, measure the part or get its drawing.</source>
        <translation>{0} mm² ({1} %) der Außenfläche sind erfunden: Kontakte dort beruhen auf einer Vermutung. Wenn sie dort berührt wird, messen Sie das Teil, oder besorgen Sie seine Zeichnung.</translation>
    </message>
    <message>
        <source>{0} more</source>
        <translation>{0} weitere</translation>
    </message>
    <message>
        <source>{0} more fields differ: `contactbench bundle diff` lists them.</source>
        <translation>{0} weitere Felder weichen ab: `contactbench bundle diff` führt sie auf.</translation>
    </message>
    <message>
        <source>{0} must be positive and finite, not {1}</source>
        <translation>{0} muss positiv und endlich sein, nicht {1}</translation>
    </message>
    <message>
        <source>{0} must stand alone</source>
        <translation>{0} steht allein</translation>
    </message>
    <message>
        <source>{0} needs three numbers, {1}, not shape {2}</source>
        <translation>{0} braucht drei Zahlen, {1}, nicht die Form {2}</translation>
    </message>
    <message>
        <source>{0} needs {1} finite numbers separated by commas, not {2}.</source>
        <translation>{0} braucht {1} endliche Zahlen, durch Kommas getrennt, nicht {2}.</translation>
    </message>
    <message>
        <source>{0} negated</source>
        <translation>{0} negiert</translation>
    </message>
    <message>
        <source>{0} of another, with the same corners and the same side. They give double answers and slow the search. Remove duplicates in the CAD program, or make the outer shell.</source>
        <translation>Mehrfach vorhanden, mit denselben Ecken und derselben Seite: {0}. Das gibt doppelte Antworten und bremst die Suche. Entfernen Sie Duplikate im CAD-Programm, oder machen Sie die Außenfläche.</translation>
    </message>
    <message>
        <source>{0} of scatter</source>
        <translation>{0} Streuung</translation>
    </message>
    <message>
        <source>{0} of the area can be seen from both sides, like a sheet or an open bowl: it has no thickness. Check that the whole housing was exported, as a solid.</source>
        <translation>Anteil der Fläche, der von beiden Seiten zu sehen ist: {0}, wie bei einem Blatt oder einer offenen Schale: Er hat keine Dicke. Prüfen Sie, ob das ganze Gehäuse exportiert wurde, als Volumenkörper.</translation>
    </message>
    <message>
        <source>{0} of the area cannot be seen from outside.</source>
        <translation>{0} von der Fläche ist von außen nicht zu sehen.</translation>
    </message>
    <message>
        <source>{0} of the area cannot be seen from outside{1}: inner walls or parts that cannot be touched, but that a line of force can hit. {2}</source>
        <translation>Anteil der Fläche, der von außen nicht zu sehen ist: {0}{1}: Innenwände oder Teile, die nichts berühren kann, auf die aber die Wirkungslinie einer Kraft trifft. {2}</translation>
    </message>
    <message>
        <source>{0} of the area has a view of the outside only through narrow openings or from deep grooves.</source>
        <translation>{0} von der Fläche sieht nur durch enge Öffnungen oder aus tiefen Rillen nach außen.</translation>
    </message>
    <message>
        <source>{0} of the area has little or no view of the outside: grooves, bores and gaps, which the outer shell keeps. A finger hardly reaches there.</source>
        <translation>Anteil der Fläche, von dem aus wenig oder nichts von außen zu sehen ist: {0}. Das sind Rillen, Bohrungen und Spalte, die die Außenfläche behält. Ein Finger kommt dort kaum hin.</translation>
    </message>
    <message>
        <source>{0} of the area is visible from outside only through narrow openings, or lies deep in grooves. If these are inner walls behind a hole, contacts can be placed on them. {1}</source>
        <translation>Anteil der Fläche, der von außen nur durch enge Öffnungen zu sehen ist oder tief in Rillen liegt: {0}. Sind das Innenwände hinter einem Loch, so können Kontakte dorthin gelegt werden. {1}</translation>
    </message>
    <message>
        <source>{0} of the last {1} bytes belong to no frame: check cable, shield and line speed, and that no other program uses the line.</source>
        <translation>{0} der letzten {1} Bytes gehören zu keinem Frame: Kabel, Schirmung und Geschwindigkeit der Leitung prüfen, und dass nichts anderes sie benutzt.</translation>
    </message>
    <message>
        <source>{0} of the last {1} frames were damaged: check cable, shield and line speed.</source>
        <translation>{0} der letzten {1} Frames waren beschädigt: Kabel, Schirmung und Geschwindigkeit der Leitung prüfen.</translation>
    </message>
    <message>
        <source>{0} of the last {1} samples were lost according to the device&apos;s own counter: check the line, or choose a lower rate.</source>
        <translation>{0} der letzten {1} Messwerte gingen nach der eigenen Zählung des Geräts verloren: die Leitung prüfen oder eine niedrigere Rate wählen.</translation>
    </message>
    <message>
        <source>{0} of the {1} parts overlap, so walls of one lie inside another. Merge them in the CAD program, or make the outer shell before use.</source>
        <translation>{0} der {1} Teile überlappen sich, sodass Wände des einen im anderen liegen. Vereinigen Sie sie im CAD-Programm, oder erzeugen Sie vor der Verwendung die Außenhülle.</translation>
    </message>
    <message>
        <source>{0} of {1} contacts are {2} and not in the map: {3}.</source>
        <translation>{0} von {1} Kontakten sind „{2}“ und fehlen in der Karte: {3}.</translation>
    </message>
    <message>
        <source>{0} of {1} contacts are on invented facets: the mesh file had an opening there, so surface and contacts are guesses.</source>
        <translation>{0} von {1} Kontakten liegen auf erfundenen Facetten: Die Netzdatei hatte dort eine Öffnung, Fläche und Kontakte sind Vermutungen.</translation>
    </message>
    <message>
        <source>A closed mesh keeps such openings: to close the mouths of cavities, make the outer shell with --close auto (in the window: &quot;Close openings&quot;).</source>
        <translation>Ein geschlossenes Netz behält solche Öffnungen: Um die Mündungen von Hohlräumen zu schließen, die Außenhülle mit --close auto erzeugen (im Fenster: „Öffnungen schließen“).</translation>
    </message>
    <message>
        <source>A pull of up to {0} mN·m stays in the room: a cable or a hose</source>
        <translation>Ein Zug von bis zu {0} mN·m bleibt im Raum stehen: ein Kabel oder ein Schlauch</translation>
    </message>
    <message>
        <source>Found {0}.</source>
        <translation>Gefunden: {0}.</translation>
    </message>
    <message>
        <source>Gravity points {0}° away from down. Either the sensor reports the opposite sign, the orientations are turned ({1}), or the robot is not mounted upright: then give the direction of down (--down).</source>
        <translation>Die Schwerkraft weicht um {0}° von senkrecht nach unten ab. Entweder meldet der Sensor das umgekehrte Vorzeichen, die Orientierungen sind verdreht ({1}), oder der Roboter ist nicht aufrecht montiert: Geben Sie dann an, wo unten ist (--down).</translation>
    </message>
    <message>
        <source>How to close the openings, largest first, one entry each; the last entry applies to all others. auto: fair or ruled, by shape. fair: least bending. ruled: straight lines between the long rims. hull: no dent. open: leave it. [A closed mesh: open; others: auto]</source>
        <translation>Wie die Öffnungen geschlossen werden, größte zuerst, je ein Eintrag; der letzte Eintrag gilt für alle übrigen. auto: fair oder ruled, je nach Form. fair: geringste Biegung. ruled: Geraden zwischen den langen Rändern. hull: keine Delle. open: so lassen. [Geschlossenes Netz: open; andere: auto]</translation>
    </message>
    <message>
        <source>Joined exactly: {0} closed bodies that overlap, touch or lie in each other.</source>
        <translation>Exakt vereinigt: {0} geschlossene Körper, die sich überlappen, berühren oder ineinander liegen.</translation>
    </message>
    <message>
        <source>Mended in place: the outer hull was made from the facets of the file; none was moved.</source>
        <translation>Am Ort repariert: Die äußere Hülle wurde aus den Facetten der Datei gebildet; keine wurde verschoben.</translation>
    </message>
    <message>
        <source>No majority of the poses fits one gravity model. Either the orientations follow another convention than declared ({0}), or most captures were disturbed.</source>
        <translation>Keine Mehrheit der Posen passt zu einem einzigen Schwerkraftmodell. Entweder folgen die Orientierungen einer anderen Konvention als angegeben ({0}), oder die meisten Aufnahmen wurden gestört.</translation>
    </message>
    <message>
        <source>Not every topic shows that the clock was set, so from then on wrenches and poses do not belong together: cut the recording before the step. Of a bag, choose other times with --header-stamps.</source>
        <translation>Nicht jedes Topic zeigt, dass die Uhr verstellt wurde. Von da an passen Wrenches und Posen nicht zusammen: die Aufzeichnung vor dem Sprung abschneiden. Bei einem Bag mit --header-stamps andere Zeiten wählen.</translation>
    </message>
    <message>
        <source>Openings left open: {0}. A contact can be found on the walls behind them. If nothing can enter there, close them (--close auto; in the window: &quot;Close openings&quot;).</source>
        <translation>Offen gelassene Öffnungen: {0}. Ein Kontakt kann auf den Wänden dahinter gefunden werden. Wenn dort nichts eindringen kann, schließen Sie sie (--close auto; im Fenster: „Öffnungen schließen“).</translation>
    </message>
    <message>
        <source>The STEP file is damaged: it refers to entities that it does not hold ({0}). Parts or faces may be missing: export it again.</source>
        <translation>Die STEP-Datei ist beschädigt: Sie verweist auf Einträge, die sie nicht enthält ({0}). Teile oder Flächen können fehlen: neu exportieren.</translation>
    </message>
    <message>
        <source>The STEP file, drawn in {0}, was tessellated to {1} mm and {2}° and read in millimetres, with each part where its assembly places it.</source>
        <translation>Die STEP-Datei (Einheit der Zeichnung: {0}) wurde auf {1} mm und {2}° genau in Dreiecke zerlegt und in Millimetern gelesen, jedes Teil dort, wo die Baugruppe es anordnet.</translation>
    </message>
    <message>
        <source>The clock was set {0} by {1} s at {2} s. What follows is placed {3} s later, and never paired with what came before.</source>
        <translation>Die Uhr wurde bei {2} s um {1} s {0}gestellt. Alles Folgende liegt {3} s später und wird nie mit dem Vorigen gepaart.</translation>
    </message>
    <message>
        <source>The mesh&apos;s own facets could not be used: its bodies are less than the gap apart, and what fills the space between them gave no valid surface.</source>
        <translation>Die eigenen Facetten des Netzes waren nicht verwendbar: Seine Körper liegen weniger als den Spalt auseinander, und was den Raum dazwischen füllt, ergab keine gültige Fläche.</translation>
    </message>
    <message>
        <source>The sensor seems to be turned by {0}° about ({1}) from its declared mounting</source>
        <translation>Der Sensor scheint gegenüber der angegebenen Montage um {0}° um ({1}) verdreht zu sein</translation>
    </message>
    <message>
        <source>The sensor was re-zeroed</source>
        <translation>Der Sensor wurde genullt</translation>
    </message>
    <message>
        <source>The {0} are along the axes of the robot&apos;s base, not of the sensor</source>
        <translation>{0} liegen entlang der Achsen der Roboterbasis, nicht des Sensors</translation>
    </message>
    <message>
        <source>Up to {0} changes with the orientation otherwise than a weight does: crosstalk or wrong gains of the sensor, or a cable that follows the wrist</source>
        <translation>Bis zu {0} ändert sich mit der Orientierung anders als ein Gewicht: Übersprechen oder falsche Verstärkungen des Sensors oder ein Kabel, das dem Handgelenk folgt</translation>
    </message>
    <message>
        <source>What fails the verification is not the size of the errors: see its reasons.</source>
        <translation>Die Verifikation scheitert nicht an der Größe der Fehler: siehe die Gründe.</translation>
    </message>
    <message>
        <source>miss the probe: check the units (N, N·m, mm), the signs and the mount of the sensor, and the alignment of the probe.</source>
        <translation>verfehlen die Sonde: Einheiten (N, N·m, mm), Vorzeichen und Halterung des Sensors und Ausrichtung der Sonde prüfen.</translation>
    </message>
    <message>
        <source>torques in {0}</source>
        <translation>Drehmomente in {0}</translation>
    </message>
    <message>
        <source>{0} has {1} columns, and the option fields {2}</source>
        <translation>{0} hat {1} Spalten, die Option fields aber {2}</translation>
    </message>
    <message>
        <source>{0} is damaged ({1}): everything up to there was read.</source>
        <translation>{0} ist beschädigt ({1}): bis dorthin wurde alles gelesen.</translation>
    </message>
    <message>
        <source>{0} is {1}, but this runtime says {2}</source>
        <translation>{0} ist {1}, diese Laufzeit ergibt aber {2}</translation>
    </message>
    <message>
        <source>{0} messages were left out: their times are more than a day from all others.</source>
        <translation>{0} Nachrichten wurden ausgelassen: Ihre Zeiten liegen mehr als einen Tag von allen anderen entfernt.</translation>
    </message>
    <message>
        <source>{0} of {1} contacts are on untouchable regions: check the region, then the mount.</source>
        <translation>Kontakte auf Regionen, die nichts berühren kann: {0} von {1}. Prüfen Sie die Region, dann die Montage.</translation>
    </message>
    <message>
        <source>{0} of {1} facets have no part of the old surface near them and belong to no region: check that both meshes are in the same place.</source>
        <translation>{0} von {1} Facetten haben nichts von der alten Oberfläche in der Nähe und gehören zu keiner Region: Prüfen Sie, ob beide Netze an derselben Stelle liegen.</translation>
    </message>
    <message>
        <source>{0} of {1} forces pull on the surface. The wrenches must be the force of the tissue on the probe: negate them if the sensor reports the reaction. Otherwise the mesh is inside out, or the first mount is turned over.</source>
        <translation>{0} von {1} Kräften ziehen an der Oberfläche. Gebraucht wird die Kraft des Gewebes auf die Sonde: Kehren Sie sie um, wenn der Sensor die Gegenkraft ausgibt. Sonst ist das Netz umgestülpt oder die erste Montage verdreht.</translation>
    </message>
    <message>
        <source>{0} of {1} has {2} bytes instead of {3}: a pose needs position and orientation.</source>
        <translation>{0} von {1} hat {2} Bytes statt {3}: Eine Pose braucht Position und Orientierung.</translation>
    </message>
    <message>
        <source>{0} of {1} rows have empty or infinite cells; they were passed through (--allow-nan).</source>
        <translation>{0} von {1} Zeilen haben leere oder unendliche Zellen; sie wurden weitergegeben (--allow-nan).</translation>
    </message>
    <message>
        <source>{0} of {1} settled touches match no marker ({2}): their points may be wrong</source>
        <translation>{0} von {1} ruhigen Berührungen passen zu keinem Marker ({2}): Ihre Punkte können falsch sein</translation>
    </message>
    <message>
        <source>{0} of {1} settled touches {2}</source>
        <translation>{0} von {1} ruhigen Berührungen {2}</translation>
    </message>
    <message>
        <source>{0} of {1} vertices are</source>
        <translation>{0} von {1} Eckpunkten sind</translation>
    </message>
    <message>
        <source>{0} of {1}: a number is not finite: check the tracker.</source>
        <translation>{0} von {1}: Eine Zahl ist nicht endlich: Prüfen Sie den Tracker.</translation>
    </message>
    <message>
        <source>{0} of {1}: it is more than {2} m away: check that the tracker sends mm.</source>
        <translation>{0} von {1}: Er ist mehr als {2} m entfernt: Prüfen Sie, ob der Tracker mm sendet.</translation>
    </message>
    <message>
        <source>{0} of {1}: its orientation is no rotation: bring the body in sight.</source>
        <translation>{0} von {1}: Die Orientierung ist keine Drehung: Bringen Sie den Körper ins Blickfeld.</translation>
    </message>
    <message>
        <source>{0} of {1}: the tracker does not see the body ({2}): bring it in sight.</source>
        <translation>{0} von {1}: Der Tracker sieht den Körper nicht ({2}): ihn ins Sichtfeld bringen.</translation>
    </message>
    <message>
        <source>{0} on {1}</source>
        <translation>{0} auf {1}</translation>
    </message>
    <message>
        <source>{0} or {1}</source>
        <translation>{0} oder {1}</translation>
    </message>
    <message>
        <source>{0} orientations are too few to choose from: give at least 12</source>
        <translation>{0} Orientierungen sind zu wenige zur Auswahl: Geben Sie mindestens 12 an</translation>
    </message>
    <message>
        <source>{0} over {1} is not supported: use {2}.</source>
        <translation>{0} über {1} wird nicht unterstützt: Möglich ist {2}.</translation>
    </message>
    <message>
        <source>{0} points are picked, but {1} are needed: pick another one, far from these.</source>
        <translation>{0} Punkte sind gewählt, aber {1} werden gebraucht: Wählen Sie einen weiteren, weit weg von diesen.</translation>
    </message>
    <message>
        <source>{0} points in the mesh and {1} in the sensor frame: give three or more, one for one.</source>
        <translation>{0} Punkte im Netz und {1} im Sensorsystem: Geben Sie mindestens drei an, Punkt für Punkt.</translation>
    </message>
    <message>
        <source>{0} points of the mesh fitted to their positions in the sensor frame by least squares; residual {1} mm rms.</source>
        <translation>{0} Punkte des Netzes nach kleinsten Quadraten an ihre Positionen im Sensorsystem angepasst; Restabweichung {1} mm rms.</translation>
    </message>
    <message>
        <source>{0} points, {1} wrenches and {2} names: give one of each per touch.</source>
        <translation>{0} Punkte, {1} Kraft-Momenten-Werte und {2} Namen: Geben Sie je Berührung eines von jedem an.</translation>
    </message>
    <message>
        <source>{0} pose says little about other orientations. Take {1} or more.</source>
        <translation>{0} Pose sagt wenig über andere Orientierungen. Nehmen Sie {1} oder mehr.</translation>
    </message>
    <message>
        <source>{0} poses are too few. Fifteen unknowns need at least four poses that tilt about two axes; checking them against one another needs six or more.</source>
        <translation>{0} Posen sind zu wenige. Fünfzehn Unbekannte brauchen mindestens vier Posen, die um zwei Achsen geneigt sind; um sie gegeneinander zu prüfen, sind sechs oder mehr nötig.</translation>
    </message>
    <message>
        <source>{0} poses are too few. Twelve unknowns need at least three poses with different tilts; checking them against one another needs five or more.</source>
        <translation>{0} Posen sind zu wenige. Zwölf Unbekannte brauchen mindestens drei Posen mit verschiedenen Neigungen; um sie gegeneinander zu prüfen, sind fünf oder mehr nötig.</translation>
    </message>
    <message>
        <source>{0} poses say little about other orientations. Take {1} or more.</source>
        <translation>{0} Posen sagen wenig über andere Orientierungen. Nehmen Sie {1} oder mehr.</translation>
    </message>
    <message>
        <source>{0} poses: the convention check needs {1} to {2}. Take poses with different tilts about two axes; from a long recording, use only the parts where the sensor stood still.</source>
        <translation>{0} Posen: Die Prüfung der Konventionen braucht {1} bis {2}. Nehmen Sie Posen mit verschiedenen Neigungen um zwei Achsen auf; verwenden Sie von einer langen Aufzeichnung nur die Teile, in denen der Sensor stillstand.</translation>
    </message>
    <message>
        <source>{0} priority regions</source>
        <translation>{0} Regionen mit Priorität</translation>
    </message>
    <message>
        <source>{0} produced no usable mesh from &apos;{1}&apos;: repair the mesh first, or use another engine.</source>
        <translation>{0} hat bei &apos;{1}&apos; kein brauchbares Netz geliefert: zuerst das Netz reparieren oder ein anderes Verfahren nehmen.</translation>
    </message>
    <message>
        <source>{0} rad is not an angle between two directions: give 0 to 180 degrees.</source>
        <translation>{0} rad ist kein Winkel zwischen zwei Richtungen: Geben Sie 0 bis 180 Grad an.</translation>
    </message>
    <message>
        <source>{0} readings left out: empty, frozen, or flagged as bad by the device.</source>
        <translation>{0} Messwerte ausgelassen: leer, eingefroren oder vom Gerät als unbrauchbar gemeldet.</translation>
    </message>
    <message>
        <source>{0} readings left out: flagged as bad by the device.</source>
        <translation>{0} Messwerte ausgelassen: vom Gerät als unbrauchbar gemeldet.</translation>
    </message>
    <message>
        <source>{0} readings left out: flagged as bad, or without a pose.</source>
        <translation>{0} Messwerte ausgelassen: als unbrauchbar gemeldet oder ohne Pose.</translation>
    </message>
    <message>
        <source>{0} readings left out: no pose within {1} s.</source>
        <translation>{0} Messwerte ausgelassen: keine Pose innerhalb von {1} s.</translation>
    </message>
    <message>
        <source>{0} readings left out: without a pose, or flagged as bad by the device.</source>
        <translation>Ausgelassene Messwerte: {0}; ohne Pose, oder vom Gerät als unbrauchbar gemeldet.</translation>
    </message>
    <message>
        <source>{0} readings per second</source>
        <translation>{0} Messwerte pro Sekunde</translation>
    </message>
    <message>
        <source>{0} regions, more than {1}: merge or remove some.</source>
        <translation>{0} Regionen, mehr als {1}: Fassen Sie einige zusammen, oder entfernen Sie einige.</translation>
    </message>
    <message>
        <source>{0} results were computed from inputs that no earlier record contains, such as {1}.</source>
        <translation>{0} Ergebnisse wurden aus Eingaben berechnet, die in keinem früheren Eintrag stehen, etwa {1}.</translation>
    </message>
    <message>
        <source>{0} rows of &apos;{1}&apos;</source>
        <translation>{0} Zeilen von &apos;{1}&apos;</translation>
    </message>
    <message>
        <source>{0} s did not help: retracting along its path.</source>
        <translation>{0} s halfen nicht: Sie geht zurück, wie sie gekommen ist.</translation>
    </message>
    <message>
        <source>{0} s on the samples&apos; clock is no time near the start of the recording</source>
        <translation>{0} s auf der Uhr der Messwerte ist keine Zeit nahe dem Beginn der Aufzeichnung</translation>
    </message>
    <message>
        <source>{0} samples have no pose: not all transforms between the frames have their time stamp.</source>
        <translation>{0} Zeitpunkte haben keine Pose: Nicht alle Transformationen zwischen den Koordinatensystemen haben diesen Zeitstempel.</translation>
    </message>
    <message>
        <source>{0} samples per second are too few to tell stillness from motion: check that the times are in s, and give {1} or more</source>
        <translation>{0} Messwerte pro Sekunde sind zu wenige, um Ruhe von Bewegung zu unterscheiden: Prüfen Sie, ob die Zeiten in s sind, und geben Sie {1} oder mehr an</translation>
    </message>
    <message>
        <source>{0} samples since {1} s span less than {2} s: the times stand still; give the time of each sample in s</source>
        <translation>{0} Messwerte seit {1} s umfassen weniger als {2} s: Die Zeiten stehen still; geben Sie die Zeit jedes Messwerts in s an</translation>
    </message>
    <message>
        <source>{0} sends nothing: the recording waits and resumes automatically.</source>
        <translation>{0} sendet nichts: Die Aufzeichnung wartet und geht von selbst weiter.</translation>
    </message>
    <message>
        <source>{0} separate parts</source>
        <translation>{0} getrennte Teile</translation>
    </message>
    <message>
        <source>{0} stands for all columns that follow: put it last</source>
        <translation>{0} steht für alle folgenden Spalten: Setzen Sie es ans Ende</translation>
    </message>
    <message>
        <source>{0} swapped</source>
        <translation>{0} vertauscht</translation>
    </message>
    <message>
        <source>{0} then has no orientation of its own and was left out.</source>
        <translation>{0} hat dann keine eigene Orientierung und wurde ausgelassen.</translation>
    </message>
    <message>
        <source>{0} to 1</source>
        <translation>{0} zu 1</translation>
    </message>
    <message>
        <source>{0} to floor</source>
        <translation>{0} bis Boden</translation>
    </message>
    <message>
        <source>{0} to {1}</source>
        <translation>{0} bis {1}</translation>
    </message>
    <message>
        <source>{0} to {1} N</source>
        <translation>{0} bis {1} N</translation>
    </message>
    <message>
        <source>{0} touches are too few to judge an error: give at least {1}.</source>
        <translation>{0} Berührungen sind zu wenige, um einen Fehler zu beurteilen: Geben Sie mindestens {1} an.</translation>
    </message>
    <message>
        <source>{0} touches cannot prove an improvement: touch at least {1} markers, better 15.</source>
        <translation>{0} Berührungen können keine Verbesserung beweisen: Berühren Sie mindestens {1} Marker, besser 15.</translation>
    </message>
    <message>
        <source>{0} touches cannot show a mount: touch at least three markers.</source>
        <translation>{0} Berührungen können keine Montage zeigen: Berühren Sie mindestens drei Marker.</translation>
    </message>
    <message>
        <source>{0} was changed after contactbench wrote it, so the history beside it describes another surface. Prepare the mesh again unless you know who changed it.</source>
        <translation>{0} wurde geändert, nachdem contactbench die Datei geschrieben hat; der Verlauf daneben gehört zu einer anderen Oberfläche. Bereiten Sie das Netz neu vor, wenn nicht bekannt ist, wer die Datei geändert hat.</translation>
    </message>
    <message>
        <source>{0} was left in place: {1}</source>
        <translation>{0} wurde nicht verändert: {1}</translation>
    </message>
    <message>
        <source>{0} was left out: {1}. Check whether another marker was touched, or the tip slipped.</source>
        <translation>{0} wurde ausgelassen: {1}. Prüfen Sie, ob ein anderer Marker berührt wurde oder die Spitze abgerutscht ist.</translation>
    </message>
    <message>
        <source>{0} was made with another {1} than {2}: verify again.</source>
        <translation>{0} wurde mit anderer Eingabe ({1}) gemacht als {2}: erneut prüfen.</translation>
    </message>
    <message>
        <source>{0} was never finished (only {1} bytes of it exist)</source>
        <translation>{0} wurde nie fertig geschrieben (nur {1} Byte davon sind da)</translation>
    </message>
    <message>
        <source>{0} was not closed: its end may be missing.</source>
        <translation>{0} wurde nicht abgeschlossen: Das Ende kann fehlen.</translation>
    </message>
    <message>
        <source>{0} was rejected. {1}</source>
        <translation>{0} wurde abgelehnt. {1}</translation>
    </message>
    <message>
        <source>{0} with the wrong sign</source>
        <translation>{0} mit falschem Vorzeichen</translation>
    </message>
    <message>
        <source>{0} with {1}</source>
        <translation>{0} mit {1}</translation>
    </message>
    <message>
        <source>{0} with {1} facets and {2}</source>
        <translation>{0}, {1} Facetten, {2}</translation>
    </message>
    <message>
        <source>{0} without area were left out. They cannot be touched, but may have closed a seam.</source>
        <translation>Ohne Fläche und deshalb ausgelassen: {0}. So etwas kann nicht berührt werden, hat aber vielleicht eine Naht geschlossen.</translation>
    </message>
    <message>
        <source>{0} x {1} mm, {2} mm deep</source>
        <translation>{0} x {1} mm, {2} mm tief</translation>
    </message>
    <message>
        <source>{0} {1} are assumed.</source>
        <translation>{0} Angenommen werden {1}.</translation>
    </message>
    <message>
        <source>{0} {1} come too close to the limit of {2} {3}.</source>
        <translation>{0} {1} kommen der Grenze von {2} {3} zu nahe.</translation>
    </message>
    <message>
        <source>{0} {1} grow by {2} {3} per s and will soon exceed the limit of {4} {5}.</source>
        <translation>{0} {1} wachsen um {2} {3} pro s: bald über der Grenze von {4} {5}.</translation>
    </message>
    <message>
        <source>{0} {1} has no direction: give a vector that is not zero.</source>
        <translation>{0} {1} hat keine Richtung: Geben Sie einen Vektor an, der nicht null ist.</translation>
    </message>
    <message>
        <source>{0} {1} in the JSON file, where {2} belongs: export it again.</source>
        <translation>{0} {1} in der JSON-Datei, wo {2} hingehört: Exportieren Sie sie neu.</translation>
    </message>
    <message>
        <source>{0} {1} missing; found: {2}.</source>
        <translation>{0} {1} fehlt; gefunden: {2}.</translation>
    </message>
    <message>
        <source>{0} {1}: give a host and a port, such as 127.0.0.1:9000.</source>
        <translation>{0} {1}: Geben Sie Rechner und Port an, etwa 127.0.0.1:9000.</translation>
    </message>
    <message>
        <source>{0} {1}: other machines could connect there, and contacts are neither encrypted nor signed: listen on 127.0.0.1, or allow other machines (--allow-remote).</source>
        <translation>{0} {1}: Andere Rechner könnten sich verbinden, und Kontakte sind weder verschlüsselt noch signiert: Verwenden Sie 127.0.0.1, oder erlauben Sie andere Rechner (--allow-remote).</translation>
    </message>
    <message>
        <source>{0} {1}: there is no such host ({2}): write its IP address, such as 127.0.0.1.</source>
        <translation>{0} {1}: Diesen Rechner gibt es nicht ({2}): Geben Sie seine IP-Adresse an, etwa 127.0.0.1.</translation>
    </message>
    <message>
        <source>{0} {1}: this is another machine, and contacts are neither encrypted nor signed: send to 127.0.0.1, or allow other machines (--allow-remote).</source>
        <translation>{0} {1}: Das ist ein anderer Rechner, und Kontakte sind weder verschlüsselt noch signiert: Senden Sie an 127.0.0.1, oder erlauben Sie andere Rechner (--allow-remote).</translation>
    </message>
    <message>
        <source>{0}, after the {1} {2} was recorded.</source>
        <translation>{0}, nachdem dies aufgezeichnet wurde: {1} {2}.</translation>
    </message>
    <message>
        <source>{0}, and {1}.</source>
        <translation>{0}, und {1}.</translation>
    </message>
    <message>
        <source>{0}, erasing</source>
        <translation>{0}, radierend</translation>
    </message>
    <message>
        <source>{0}, possibly out of memory</source>
        <translation>{0}, vielleicht kein Arbeitsspeicher mehr</translation>
    </message>
    <message>
        <source>{0}, the journal before its migration, cannot be read ({1})</source>
        <translation>{0}, das Journal vor der Migration, kann nicht gelesen werden ({1})</translation>
    </message>
    <message>
        <source>{0}, the journal before its migration, was changed</source>
        <translation>{0}, das Journal vor der Migration, wurde verändert</translation>
    </message>
    <message>
        <source>{0}, the last one, disagrees: it was bumped, or the sensor&apos;s zero jumped before it and the bias is wrong. Take one or two more poses to find out which.</source>
        <translation>{0}, die letzte, passt nicht zu den anderen: Sie wurde angestoßen, oder der Nullpunkt des Sensors sprang davor und der Nullpunktfehler ist falsch. Nehmen Sie noch eine oder zwei Posen auf, um das zu klären.</translation>
    </message>
    <message>
        <source>{0}. All but the largest are specks, which the preparation leaves out.</source>
        <translation>{0}. Alle außer dem größten sind Krümel, die die Vorbereitung auslässt.</translation>
    </message>
    <message>
        <source>{0}. If this is a recording, add the time of each row in s as column t: contactbench calibrate fit and contactbench calibrate captures then find the still poses in it.</source>
        <translation>{0}. Falls dies eine Aufzeichnung ist, fügen Sie die Zeit jeder Zeile in s als Spalte t hinzu: contactbench calibrate fit und contactbench calibrate captures finden dann die ruhigen Posen darin.</translation>
    </message>
    <message>
        <source>{0}. Simplification treats each by itself.</source>
        <translation>{0}. Die Vereinfachung behandelt jedes für sich.</translation>
    </message>
    <message>
        <source>{0}. With that corrected, {1} and {2}. {3}</source>
        <translation>{0}. Damit berichtigt, {1} und {2}. {3}</translation>
    </message>
    <message>
        <source>{0}: &lt;{1}&gt; has {2}={3}: every number must be finite. Correct it.</source>
        <translation>{0}: &lt;{1}&gt; hat {2}={3}: Jede Zahl muss endlich sein. Korrigieren Sie sie.</translation>
    </message>
    <message>
        <source>{0}: VANISHED, it had {1} mm².</source>
        <translation>{0}: VERSCHWUNDEN, sie hatte {1} mm².</translation>
    </message>
    <message>
        <source>{0}: a facet has the region {1}, but regions lists {2}. {3}</source>
        <translation>{0}: Eine Facette hat die Region {1}, aber Einträge in regions: {2}. {3}</translation>
    </message>
    <message>
        <source>{0}: a file or a link has this name: choose another folder, or a .zip name.</source>
        <translation>{0}: Eine Datei oder einen Link dieses Namens gibt es schon: einen anderen Ordner oder einen Namen auf .zip wählen.</translation>
    </message>
    <message>
        <source>{0}: a frame is more than {1} m from the one before it: give positions in m.</source>
        <translation>{0}: Ein Koordinatensystem ist mehr als {1} m von dem davor entfernt: Geben Sie Positionen in m an.</translation>
    </message>
    <message>
        <source>{0}: a link has no name: give it one.</source>
        <translation>{0}: Ein Link hat keinen Namen: Geben Sie ihm einen.</translation>
    </message>
    <message>
        <source>{0}: a link or a file, not a folder: put the folder itself there.</source>
        <translation>{0}: Eine Verknüpfung oder eine Datei, kein Ordner: Legen Sie den Ordner selbst dort ab.</translation>
    </message>
    <message>
        <source>{0}: a link; a session holds only files: put the file itself there.</source>
        <translation>{0}: Eine Verknüpfung: Eine Sitzung enthält nur Dateien; legen Sie die Datei selbst dort ab.</translation>
    </message>
    <message>
        <source>{0}: a probe is saved as PLY, which keeps its regions: end the name in .ply.</source>
        <translation>{0}: Eine Sonde wird als PLY gespeichert, das ihre Regionen behält: Lassen Sie den Namen auf .ply enden.</translation>
    </message>
    <message>
        <source>{0}: a recording states its own orientation convention and contains the robot&apos;s poses: leave out the convention and the robot&apos;s table.</source>
        <translation>{0}: Eine Aufzeichnung nennt ihre eigene Konvention der Orientierungen und enthält die Posen des Roboters: Lassen Sie die Konvention und die Tabelle des Roboters weg.</translation>
    </message>
    <message>
        <source>{0}: a sample on {1} cannot be recorded: {2}. Check its device.</source>
        <translation>{0}: Ein Messwert auf {1} lässt sich nicht aufzeichnen: {2}. Prüfen Sie das Gerät, das ihn lieferte.</translation>
    </message>
    <message>
        <source>{0}: a session cannot be made here ({1}): choose another location.</source>
        <translation>{0}: Hier kann keine Sitzung angelegt werden ({1}): Wählen Sie einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: a table has wrench and pose in one row, so a delay has no meaning: use a recording (.mcap), or a separate table of robot poses.</source>
        <translation>{0}: Eine Tabelle hat Kraft/Moment und Pose in einer Zeile, ein Verzug ist dann ohne Bedeutung: Verwenden Sie eine Aufzeichnung (.mcap), oder eine eigene Tabelle der Roboterposen.</translation>
    </message>
    <message>
        <source>{0}: a table of still poses has no delay: leave it out.</source>
        <translation>{0}: Eine Tabelle ruhiger Posen hat keinen Verzug: Lassen Sie ihn weg.</translation>
    </message>
    <message>
        <source>{0}: a vertex is more than {1} m from the sensor: check that the probe is in metres. {2}</source>
        <translation>{0}: Ein Eckpunkt ist mehr als {1} m vom Sensor entfernt: Ist die Sonde in Metern? {2}</translation>
    </message>
    <message>
        <source>{0}: a {1} is computed from {2}.</source>
        <translation>{0}: {1} wird berechnet aus {2}.</translation>
    </message>
    <message>
        <source>{0}: acceleration must be above 0, not {1}</source>
        <translation>{0}: acceleration muss über 0 liegen, nicht {1}</translation>
    </message>
    <message>
        <source>{0}: an archive cannot be made here ({1}): choose another location.</source>
        <translation>{0}: Hier kann kein Archiv angelegt werden ({1}): Wählen Sie einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: an event is longer than 1 MiB: keep such data in a file.</source>
        <translation>{0}: Ein Ereignis ist länger als 1 MiB: Legen Sie solche Daten in einer Datei ab.</translation>
    </message>
    <message>
        <source>{0}: an input cannot be read ({1}): run `session verify`.</source>
        <translation>{0}: Eine Eingabe kann nicht gelesen werden ({1}): Führen Sie `session verify` aus.</translation>
    </message>
    <message>
        <source>{0}: an input changed while it was read: run `session verify`.</source>
        <translation>{0}: Eine Eingabe hat sich beim Lesen geändert: Führen Sie `session verify` aus.</translation>
    </message>
    <message>
        <source>{0}: another process is writing to this session ({1}): close it there first. Reading is always possible.</source>
        <translation>{0}: Ein anderer Prozess schreibt in diese Sitzung ({1}): Schließen Sie sie zuerst dort. Lesen ist immer möglich.</translation>
    </message>
    <message>
        <source>{0}: another program changed the journal, so the action was not recorded: reload the session.</source>
        <translation>{0}: Ein anderes Programm hat das Journal geändert, deshalb wurde die Aktion nicht vermerkt: Laden Sie die Sitzung neu.</translation>
    </message>
    <message>
        <source>{0}: at least one joint is needed</source>
        <translation>{0}: Mindestens ein Gelenk wird gebraucht</translation>
    </message>
    <message>
        <source>{0}: at {1} s is before {2} s of a line above: put them in order.</source>
        <translation>{0}: at {1} s liegt vor {2} s einer Zeile darüber: Ordnen Sie die Zeilen.</translation>
    </message>
    <message>
        <source>{0}: between the base and {1} there are no joints, or joints that do not turn: give an arm of hinges, or name another frame as its flange.</source>
        <translation>{0}: Zwischen der Basis und {1} sind keine Gelenke oder welche, die sich nicht drehen: Geben Sie einen Arm mit Drehgelenken an, oder nennen Sie ein anderes Koordinatensystem als Flansch.</translation>
    </message>
    <message>
        <source>{0}: bundle verified, {1} files. Ready for a robot&apos;s runtime.</source>
        <translation>{0}: Bundle geprüft, {1} Dateien. Bereit für die Laufzeit eines Roboters.</translation>
    </message>
    <message>
        <source>{0}: byte {1} differs from what contactbench writes (a space, a duplicate or misplaced key, or another spelling of a number or a text): {2}</source>
        <translation>{0}: Byte {1} weicht von dem ab, was contactbench schreibt (ein Leerzeichen, ein doppelter oder falsch einsortierter Schlüssel, oder eine andere Schreibweise einer Zahl oder eines Texts): {2}</translation>
    </message>
    <message>
        <source>{0}: byte {1} differs from what contactbench writes for this mesh. {2}</source>
        <translation>{0}: Byte {1} ist nicht so, wie contactbench dieses Netz schreibt. {2}</translation>
    </message>
    <message>
        <source>{0}: cannot be written ({1}): this step cannot be undone.</source>
        <translation>{0}: kann nicht geschrieben werden ({1}): Dieser Schritt lässt sich nicht rückgängig machen.</translation>
    </message>
    <message>
        <source>{0}: capsule {1} sits on body {2}, but bodies run from 0 to {3}</source>
        <translation>{0}: Die Kapsel {1} sitzt auf Körper {2}, aber die Körper gehen von 0 bis {3}</translation>
    </message>
    <message>
        <source>{0}: closed, or an earlier write failed: reload the session.</source>
        <translation>{0}: Geschlossen, oder ein früheres Schreiben ist fehlgeschlagen: Laden Sie die Sitzung neu.</translation>
    </message>
    <message>
        <source>{0}: column t runs from {1} to {2} s, that of {3} from {4} to {5} s: they do not overlap. Write both with the same clock, in s.</source>
        <translation>{0}: Spalte t läuft von {1} bis {2} s, die von {3} von {4} bis {5} s: Sie überlappen nicht. Schreiben Sie beide mit derselben Uhr, in s.</translation>
    </message>
    <message>
        <source>{0}: complete the row or remove it.</source>
        <translation>{0}: Ergänzen oder entfernen Sie die Zeile.</translation>
    </message>
    <message>
        <source>{0}: connection lost ({1}): check cable and device, then reconnect.</source>
        <translation>{0}: Verbindung verloren ({1}): Kabel und Gerät prüfen, dann neu verbinden.</translation>
    </message>
    <message>
        <source>{0}: connection lost ({1}): check the plug, then reconnect.</source>
        <translation>{0}: Verbindung verloren ({1}): den Stecker prüfen, dann neu verbinden.</translation>
    </message>
    <message>
        <source>{0}: correct or remove the row.</source>
        <translation>{0}: Berichtigen oder entfernen Sie die Zeile.</translation>
    </message>
    <message>
        <source>{0}: created has no time zone: use datetime.now(UTC).</source>
        <translation>{0}: created hat keine Zeitzone: Verwenden Sie datetime.now(UTC).</translation>
    </message>
    <message>
        <source>{0}: created is not a time ({1}): {2}</source>
        <translation>{0}: created ist keine Zeit ({1}): {2}</translation>
    </message>
    <message>
        <source>{0}: down_W is not of length 1: {1}</source>
        <translation>{0}: down_W hat nicht die Länge 1: {1}</translation>
    </message>
    <message>
        <source>{0}: empty before, {1} mm² now.</source>
        <translation>{0}: vorher leer, jetzt {1} mm².</translation>
    </message>
    <message>
        <source>{0}: exactly the same for {1} samples, and farther than ever before: this looks like the end of the range. Remove the load, and use less force.</source>
        <translation>{0}: genau gleich über {1} Messwerte, und weiter als je zuvor: Das sieht nach dem Ende des Messbereichs aus. Entfernen Sie die Last, und wenden Sie weniger Kraft an.</translation>
    </message>
    <message>
        <source>{0}: give both --base and --flange, the two frames of the pose.</source>
        <translation>{0}: Geben Sie --base und --flange beide an, die beiden Systeme der Pose.</translation>
    </message>
    <message>
        <source>{0}: give either at or after, s.</source>
        <translation>{0}: Geben Sie entweder at oder after an, s.</translation>
    </message>
    <message>
        <source>{0}: give finite numbers: a rotation (3, 3) and a place (3,), m.</source>
        <translation>{0}: Geben Sie endliche Zahlen an: eine Drehung (3, 3) und einen Ort (3,), m.</translation>
    </message>
    <message>
        <source>{0}: give its calibration.json, too: the weight of the probe is in its readings.</source>
        <translation>{0}: Geben Sie auch die zugehörige calibration.json an: Das Gewicht der Sonde steckt in den Messwerten.</translation>
    </message>
    <message>
        <source>{0}: give its key, as in {1}:data.{2}</source>
        <translation>{0}: Geben Sie seinen Schlüssel an, etwa {1}:data.{2}</translation>
    </message>
    <message>
        <source>{0}: give the probe that was touched, too: the .ply that was prepared.</source>
        <translation>{0}: Geben Sie auch die berührte Sonde an: die vorbereitete .ply-Datei.</translation>
    </message>
    <message>
        <source>{0}: give {1} finite numbers, one for each contact.</source>
        <translation>{0}: {1} endliche Zahlen angeben, eine für jeden Kontakt.</translation>
    </message>
    <message>
        <source>{0}: inertia must be six finite numbers, not {1}</source>
        <translation>{0}: inertia muss aus sechs endlichen Zahlen bestehen, nicht {1}</translation>
    </message>
    <message>
        <source>{0}: it already exists: choose another name, or delete it.</source>
        <translation>{0}: Das gibt es schon: Wählen Sie einen anderen Namen, oder löschen Sie es.</translation>
    </message>
    <message>
        <source>{0}: it begins with &lt;{1}&gt;: give a URDF (&lt;robot&gt;) or MJCF (&lt;mujoco&gt;) file.</source>
        <translation>{0}: Die Datei beginnt mit &lt;{1}&gt;: Geben Sie eine URDF- (&lt;robot&gt;) oder MJCF-Datei (&lt;mujoco&gt;) an.</translation>
    </message>
    <message>
        <source>{0}: it cannot be copied ({1}): check the file and the free disk space.</source>
        <translation>{0}: Sie kann nicht kopiert werden ({1}): Prüfen Sie die Datei und den freien Platz.</translation>
    </message>
    <message>
        <source>{0}: it cannot be read ({1}): give a text file of commands.</source>
        <translation>{0}: kann nicht gelesen werden ({1}): Geben Sie eine Textdatei mit Befehlen an.</translation>
    </message>
    <message>
        <source>{0}: it cannot be unpacked ({1}): run zstd -d on it.</source>
        <translation>{0}: Die Datei lässt sich nicht entpacken ({1}): zstd -d darauf anwenden.</translation>
    </message>
    <message>
        <source>{0}: it cannot be written ({1}): choose a writable location.</source>
        <translation>{0}: Es kann nicht geschrieben werden ({1}): Wählen Sie einen beschreibbaren Ort.</translation>
    </message>
    <message>
        <source>{0}: it cannot be written ({1}): choose another location.</source>
        <translation>{0}: kann nicht geschrieben werden ({1}): Wählen Sie einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: it cannot be written ({1}): free disk space, or choose another location.</source>
        <translation>{0}: Es kann nicht geschrieben werden ({1}): Schaffen Sie Platz, oder wählen Sie einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: it contains no controller: choose the gains.json of control tune.</source>
        <translation>{0}: Darin steht keine Regelung: die gains.json von control tune wählen.</translation>
    </message>
    <message>
        <source>{0}: it contains no journal: this is not a session.</source>
        <translation>{0}: Sie enthält kein Journal: Dies ist keine Sitzung.</translation>
    </message>
    <message>
        <source>{0}: it contains {1} of several devices: add ?topic= with one of {2}.</source>
        <translation>{0}: Darin sind Daten mehrerer Geräte ({1}): Ergänzen Sie ?topic= mit einem von: {2}.</translation>
    </message>
    <message>
        <source>{0}: it contains {1} twice: this is not a session.</source>
        <translation>{0}: {1} ist zweimal darin: Dies ist keine Sitzung.</translation>
    </message>
    <message>
        <source>{0}: it has a document type, which no robot&apos;s description needs: remove it.</source>
        <translation>{0}: Sie hat einen Dokumenttyp, den keine Roboterbeschreibung braucht: Entfernen Sie ihn.</translation>
    </message>
    <message>
        <source>{0}: it has no commands: add a line such as {&quot;at&quot;: 1, &quot;do&quot;: &quot;end&quot;}.</source>
        <translation>{0}: enthält keine Befehle: Fügen Sie eine Zeile hinzu, etwa {&quot;at&quot;: 1, &quot;do&quot;: &quot;end&quot;}.</translation>
    </message>
    <message>
        <source>{0}: it has no frame {1}. Possible: {2}.</source>
        <translation>{0}: Sie hat kein Koordinatensystem {1}. Möglich: {2}.</translation>
    </message>
    <message>
        <source>{0}: it has no joint that turns: give the file of an arm.</source>
        <translation>{0}: Sie hat kein Drehgelenk: Geben Sie die Datei eines Arms an.</translation>
    </message>
    <message>
        <source>{0}: it has no message that can be read. {1}</source>
        <translation>{0}: Keine Nachricht ist lesbar. {1}</translation>
    </message>
    <message>
        <source>{0}: it has no {1} on {2}: choose another recording or topic; contactbench record info lists its content.</source>
        <translation>{0}: Sie enthält keine {1} auf {2}: Wählen Sie eine andere Aufzeichnung oder ein anderes Topic; contactbench record info zeigt den Inhalt.</translation>
    </message>
    <message>
        <source>{0}: it has {1} bodies: give the file of one arm alone.</source>
        <translation>{0}: Sie hat {1} Körper: Geben Sie die Datei eines einzelnen Arms an.</translation>
    </message>
    <message>
        <source>{0}: it includes other files: give the file that has the arm itself.</source>
        <translation>{0}: Sie bindet andere Dateien ein: Geben Sie die Datei an, in der der Arm selbst steht.</translation>
    </message>
    <message>
        <source>{0}: it is due after {1} s, the longest run: split the script.</source>
        <translation>{0}: erst nach {1} s fällig, dem längsten Lauf: Teilen Sie das Skript.</translation>
    </message>
    <message>
        <source>{0}: it is no file: give a URDF or MJCF file.</source>
        <translation>{0}: Das ist keine Datei: Geben Sie eine URDF- oder MJCF-Datei an.</translation>
    </message>
    <message>
        <source>{0}: it is no robot that MuJoCo can read ({1}).</source>
        <translation>{0}: Das ist kein Roboter, den MuJoCo lesen kann ({1}).</translation>
    </message>
    <message>
        <source>{0}: it is not UTF-8 text: save it as UTF-8.</source>
        <translation>{0}: Das ist kein Text in UTF-8: Speichern Sie die Datei als UTF-8.</translation>
    </message>
    <message>
        <source>{0}: it is not XML ({1}): give a URDF or MJCF file.</source>
        <translation>{0}: Das ist kein XML ({1}): Geben Sie eine URDF- oder MJCF-Datei an.</translation>
    </message>
    <message>
        <source>{0}: it multiplies bodies (&lt;{1}&gt;): give the file of one arm alone.</source>
        <translation>{0}: Die Datei vervielfacht Körper (&lt;{1}&gt;): Geben Sie die Datei eines einzelnen Arms an.</translation>
    </message>
    <message>
        <source>{0}: it unpacks to far more than a bag: choose another.</source>
        <translation>{0}: Entpackt ist sie viel größer als ein Bag: eine andere Datei wählen.</translation>
    </message>
    <message>
        <source>{0}: its driver has no emulator.</source>
        <translation>{0}: Sein Treiber hat keinen Emulator.</translation>
    </message>
    <message>
        <source>{0}: its end cannot be written ({1}): free disk space.</source>
        <translation>{0}: Das Ende kann nicht geschrieben werden ({1}): Schaffen Sie Platz.</translation>
    </message>
    <message>
        <source>{0}: its files overlap: this is not a session.</source>
        <translation>{0}: Die Dateien darin überlappen: Dies ist keine Sitzung.</translation>
    </message>
    <message>
        <source>{0}: its first record does not state the version it was migrated from: restore the session from a backup.</source>
        <translation>{0}: Der erste Eintrag nennt nicht, von welcher Version migriert wurde: Stellen Sie die Sitzung aus einer Sicherung wieder her.</translation>
    </message>
    <message>
        <source>{0}: its first record does not state {1}: choose a session folder.</source>
        <translation>{0}: Der erste Eintrag nennt kein {1}: Wählen Sie einen Sitzungsordner.</translation>
    </message>
    <message>
        <source>{0}: its reader has closed it.</source>
        <translation>{0}: Der Leser hat die Verbindung geschlossen.</translation>
    </message>
    <message>
        <source>{0}: joint {1}: its limits are {2} to {3} rad, more than two turns: if they are degrees, give them in radians; a joint without an end has type=&quot;continuous&quot;.</source>
        <translation>{0}: Gelenk {1}: Seine Grenzen sind {2} bis {3} rad, mehr als zwei Umdrehungen: Wenn es Grad sind, geben Sie sie im Bogenmaß an; ein Gelenk ohne Anschlag hat type=&quot;continuous&quot;.</translation>
    </message>
    <message>
        <source>{0}: joint {1}: its limits are {2} to {3}: give a lower limit below the upper one, or type=&quot;continuous&quot; to a joint without an end.</source>
        <translation>{0}: Gelenk {1}: Seine Grenzen sind {2} bis {3}: Geben Sie eine untere Grenze unter der oberen an, oder einem Gelenk ohne Anschlag type=&quot;continuous&quot;.</translation>
    </message>
    <message>
        <source>{0}: larger than the archive declares: this is not a session.</source>
        <translation>{0}: Größer, als das Archiv angibt: Dies ist keine Sitzung.</translation>
    </message>
    <message>
        <source>{0}: larger than {1} MiB: choose a calibration file.</source>
        <translation>{0}: größer als {1} MiB: Wählen Sie eine Kalibrierungsdatei.</translation>
    </message>
    <message>
        <source>{0}: larger than {1} MiB: choose a settings file.</source>
        <translation>{0}: größer als {1} MiB: eine Datei mit Einstellungen wählen.</translation>
    </message>
    <message>
        <source>{0}: larger than {1} MiB: not a table of markers. Choose the right file.</source>
        <translation>{0}: größer als {1} MiB: keine Tabelle mit Markern. Wählen Sie die richtige Datei.</translation>
    </message>
    <message>
        <source>{0}: larger than {1} MiB: start a new session.</source>
        <translation>{0}: Größer als {1} MiB: Beginnen Sie eine neue Sitzung.</translation>
    </message>
    <message>
        <source>{0}: limits must be finite with lower &lt; upper, not {1} .. {2}</source>
        <translation>{0}: Die Grenzen müssen endlich sein, mit lower &lt; upper, nicht {1} .. {2}</translation>
    </message>
    <message>
        <source>{0}: line 1: each of {1} must appear once; check {2}.</source>
        <translation>{0}: Zeile 1: jede dieser Spalten muss einmal vorkommen: {1}; zu prüfen: {2}.</translation>
    </message>
    <message>
        <source>{0}: line {1} holds something other than a number ({2}). {3}</source>
        <translation>{0}: Zeile {1} enthält etwas anderes als eine Zahl ({2}). {3}</translation>
    </message>
    <message>
        <source>{0}: line {1} is neither a pose nor a sample. {2}</source>
        <translation>{0}: Zeile {1} ist weder eine Pose noch ein Messwert. {2}</translation>
    </message>
    <message>
        <source>{0}: line {1}: facet {2} occurs twice: keep one row.</source>
        <translation>{0}: Zeile {1}: Facette {2} kommt zweimal vor: Behalten Sie eine Zeile.</translation>
    </message>
    <message>
        <source>{0}: line {1}: {2}</source>
        <translation>{0}: Zeile {1}: {2}</translation>
    </message>
    <message>
        <source>{0}: line {1}: {2} is {3}, not a whole number from 0 to {4}.</source>
        <translation>{0}: Zeile {1}: {2} ist {3}, keine ganze Zahl von 0 bis {4}.</translation>
    </message>
    <message>
        <source>{0}: longer than {1} characters: check that it is a script.</source>
        <translation>{0}: länger als {1} Zeichen: Ist es ein Skript?</translation>
    </message>
    <message>
        <source>{0}: mass_kg is {1}, but gravity_W_N over {2} m/s² is {3}: {4}</source>
        <translation>{0}: mass_kg ist {1}, aber gravity_W_N geteilt durch {2} m/s² ist {3}: {4}</translation>
    </message>
    <message>
        <source>{0}: mount.covariance_rad2</source>
        <translation>{0}: mount.covariance_rad2</translation>
    </message>
    <message>
        <source>{0}: mount.quaternion_SE is not of length 1: {1}</source>
        <translation>{0}: mount.quaternion_SE hat nicht die Länge 1: {1}</translation>
    </message>
    <message>
        <source>{0}: name the two frames of the flange&apos;s pose: --base NAME --flange NAME. There are: {1}.</source>
        <translation>{0}: Nennen Sie die beiden Systeme der Flanschpose: --base NAME --flange NAME. Vorhanden: {1}.</translation>
    </message>
    <message>
        <source>{0}: never_touch names no capsule of this arm: {1}</source>
        <translation>{0}: never_touch nennt etwas, das keine Kapsel dieses Arms ist: {1}</translation>
    </message>
    <message>
        <source>{0}: no MQTT broker answers there: the connection ended at once. Check host and port.</source>
        <translation>{0}: Dort antwortet kein MQTT-Broker: Die Verbindung endete sofort. Prüfen Sie Host und Port.</translation>
    </message>
    <message>
        <source>{0}: no answer for {1} s: check that the controller is not busy. Reconnecting.</source>
        <translation>{0}: seit {1} s keine Antwort: prüfen, ob die Steuerung nicht ausgelastet ist. Die Verbindung wird neu aufgebaut.</translation>
    </message>
    <message>
        <source>{0}: no connection ({1}): check that the device is on, in this network, and not in use.</source>
        <translation>{0}: keine Verbindung ({1}): prüfen, ob das Gerät eingeschaltet, in diesem Netzwerk und nicht in Gebrauch ist.</translation>
    </message>
    <message>
        <source>{0}: no contact was published: check its address, and who receives there.</source>
        <translation>{0}: Es wurde kein Kontakt veröffentlicht: Prüfen Sie die Adresse und den Empfänger.</translation>
    </message>
    <message>
        <source>{0}: no intact record: restore the session from an archive or a backup.</source>
        <translation>{0}: Kein unversehrter Eintrag: Stellen Sie die Sitzung aus einem Archiv oder einer Sicherung wieder her.</translation>
    </message>
    <message>
        <source>{0}: no output was accepted for {1} s, so the rest is lost: read the output.</source>
        <translation>{0}: seit {1} s wurde nichts abgenommen, der Rest ist verloren: die Ausgabe lesen.</translation>
    </message>
    <message>
        <source>{0}: no reading has a pose close enough in time. {1}</source>
        <translation>{0}: Kein Messwert hat eine Pose, die zeitlich nahe genug liegt. {1}</translation>
    </message>
    <message>
        <source>{0}: no reading has a pose: record the robot throughout.</source>
        <translation>{0}: Zu keinem Messwert gibt es eine Pose: Zeichnen Sie den Roboter durchgehend auf.</translation>
    </message>
    <message>
        <source>{0}: no reading has a pose: record the robot together with the sensor.</source>
        <translation>{0}: Zu keinem Messwert gibt es eine Pose: Zeichnen Sie den Roboter zusammen mit dem Sensor auf.</translation>
    </message>
    <message>
        <source>{0}: no reading of {1} is usable for the table. {2}</source>
        <translation>{0}: Kein Messwert von {1} ist für die Tabelle brauchbar. {2}</translation>
    </message>
    <message>
        <source>{0}: no sample arrived, so nothing was kept: check that the sensor sends samples, then start again.</source>
        <translation>{0}: Kein Messwert kam an, deshalb wurde nichts behalten: Prüfen Sie, ob der Sensor Messwerte sendet, und beginnen Sie dann neu.</translation>
    </message>
    <message>
        <source>{0}: no sample for {1} s: check that the device has power and that no other program uses its line.</source>
        <translation>{0}: seit {1} s kein Messwert: prüfen, ob das Gerät Strom hat und kein anderes Programm seine Leitung benutzt.</translation>
    </message>
    <message>
        <source>{0}: no simplified mesh suffices. Even with {1} {2}.</source>
        <translation>{0}: Kein vereinfachtes genügt. Selbst mit {1} gilt: {2}.</translation>
    </message>
    <message>
        <source>{0}: no simplified one was measured.</source>
        <translation>{0}: Kein vereinfachtes wurde gemessen.</translation>
    </message>
    <message>
        <source>{0}: no touch was accepted, so there is nothing to export: verify again.</source>
        <translation>{0}: Keine Berührung wurde gezählt, es gibt nichts zu exportieren: erneut prüfen.</translation>
    </message>
    <message>
        <source>{0}: none of the regions lies on this surface: they were painted on another mesh, or in another place. Paint them again, or leave them out.</source>
        <translation>{0}: Nichts von den Regionen liegt auf dieser Oberfläche: Sie wurden auf einem anderen Netz oder an einer anderen Stelle gemalt. Malen Sie sie neu, oder lassen Sie sie weg.</translation>
    </message>
    <message>
        <source>{0}: not CSV text ({1}): save it as UTF-8 CSV.</source>
        <translation>{0}: kein CSV-Text ({1}): Speichern Sie ihn als CSV in UTF-8.</translation>
    </message>
    <message>
        <source>{0}: not a JSON object: write {&quot;at&quot;: 2, &quot;do&quot;: &quot;release&quot;} or the like.</source>
        <translation>{0}: kein JSON-Objekt: Schreiben Sie {&quot;at&quot;: 2, &quot;do&quot;: &quot;release&quot;} oder Ähnliches.</translation>
    </message>
    <message>
        <source>{0}: not a JSON object: {1}</source>
        <translation>{0}: kein JSON-Objekt: {1}</translation>
    </message>
    <message>
        <source>{0}: not a complete session: {1}</source>
        <translation>{0}: Keine vollständige Sitzung: {1}</translation>
    </message>
    <message>
        <source>{0}: not a recording of contactbench. {1}</source>
        <translation>{0}: Dies ist keine Aufzeichnung von contactbench. {1}</translation>
    </message>
    <message>
        <source>{0}: not a regular file: choose a file.</source>
        <translation>{0}: Keine gewöhnliche Datei: Wählen Sie eine Datei.</translation>
    </message>
    <message>
        <source>{0}: not a regular file: choose a session folder.</source>
        <translation>{0}: Keine gewöhnliche Datei: Wählen Sie einen Sitzungsordner.</translation>
    </message>
    <message>
        <source>{0}: not a regular file: move it away, or choose another folder.</source>
        <translation>{0}: Keine gewöhnliche Datei: Verschieben Sie sie, oder wählen Sie einen anderen Ordner.</translation>
    </message>
    <message>
        <source>{0}: not a {1} of version {2}: {3}</source>
        <translation>{0}: kein {1} der Version {2}: {3}</translation>
    </message>
    <message>
        <source>{0}: not a {1} of version {2}: {3}.</source>
        <translation>{0}: Das ist kein {1} der Version {2}: {3}.</translation>
    </message>
    <message>
        <source>{0}: not an MCAP file: choose a recording or a ROS 2 bag.</source>
        <translation>{0}: Dies ist keine MCAP-Datei: Wählen Sie eine Aufzeichnung oder ein ROS-2-Bag.</translation>
    </message>
    <message>
        <source>{0}: not an intact zip file ({1}): copy it again.</source>
        <translation>{0}: Keine unversehrte Zip-Datei ({1}): Kopieren Sie sie noch einmal.</translation>
    </message>
    <message>
        <source>{0}: not an intact zip file ({1}): {2}</source>
        <translation>{0}: Das ist keine einwandfreie Zip-Datei ({1}): {2}</translation>
    </message>
    <message>
        <source>{0}: not captured</source>
        <translation>{0}: nicht aufgenommen</translation>
    </message>
    <message>
        <source>{0}: not enough memory: export the part with fewer facets.</source>
        <translation>{0}: zu wenig Arbeitsspeicher: Exportieren Sie das Teil mit weniger Facetten.</translation>
    </message>
    <message>
        <source>{0}: not packed because the session has a problem: {1}</source>
        <translation>{0}: Nicht gepackt, denn die Sitzung hat ein Problem: {1}</translation>
    </message>
    <message>
        <source>{0}: not running yet: start the emulator first.</source>
        <translation>{0}: läuft noch nicht: zuerst den Emulator starten.</translation>
    </message>
    <message>
        <source>{0}: not valid JSON ({1}): choose a calibration file, or copy it again.</source>
        <translation>{0}: kein gültiges JSON ({1}): Wählen Sie eine Kalibrierungsdatei, oder kopieren Sie sie noch einmal.</translation>
    </message>
    <message>
        <source>{0}: not valid JSON ({1}): choose a {2}.</source>
        <translation>{0}: Das ist kein JSON ({1}): eine andere Datei wählen ({2}).</translation>
    </message>
    <message>
        <source>{0}: not valid JSON ({1}): choose an alignment file.</source>
        <translation>{0}: kein gültiges JSON ({1}): Wählen Sie eine Ausrichtungsdatei.</translation>
    </message>
    <message>
        <source>{0}: not valid JSON ({1}): correct it.</source>
        <translation>{0}: Das ist kein JSON ({1}): berichtigen.</translation>
    </message>
    <message>
        <source>{0}: not valid JSON ({1}): write {&quot;at&quot;: 2, &quot;do&quot;: &quot;release&quot;} or the like.</source>
        <translation>{0}: kein gültiges JSON ({1}): Schreiben Sie {&quot;at&quot;: 2, &quot;do&quot;: &quot;release&quot;} oder Ähnliches.</translation>
    </message>
    <message>
        <source>{0}: not valid JSON ({1}): {2}</source>
        <translation>{0}: kein gültiges JSON ({1}): {2}</translation>
    </message>
    <message>
        <source>{0}: not writable: open the session read-only, make it writable, or work on a copy of its folder.</source>
        <translation>{0}: nicht beschreibbar: Öffnen Sie die Sitzung schreibgeschützt, machen Sie sie beschreibbar, oder arbeiten Sie mit einer Kopie ihres Ordners.</translation>
    </message>
    <message>
        <source>{0}: nothing accepts a connection there: start the broker, or check host and port.</source>
        <translation>{0}: Dort nimmt nichts eine Verbindung an: Starten Sie den Broker oder prüfen Sie Host und Port.</translation>
    </message>
    <message>
        <source>{0}: nothing received for {1} s: check cable and device. Reconnecting.</source>
        <translation>{0}: seit {1} s nichts empfangen: Kabel und Gerät prüfen. Die Verbindung wird neu aufgebaut.</translation>
    </message>
    <message>
        <source>{0}: nothing touched the probe in it: touch it while recording.</source>
        <translation>{0}: Darin hat nichts die Sonde berührt: Berühren Sie sie während der Aufzeichnung.</translation>
    </message>
    <message>
        <source>{0}: of version {1}, read as version {2}. Its test vectors, if any, tell in `bundle check` how far contacts moved since its export.</source>
        <translation>{0}: Version {1}, als Version {2} gelesen. Wie weit sich Kontakte seit dem Export verschoben haben, sagen in `bundle check` seine Testvektoren, falls es welche hat.</translation>
    </message>
    <message>
        <source>{0}: older version {1}; it will be migrated on the next write.</source>
        <translation>{0}: ältere Version {1}; sie wird beim nächsten Schreiben migriert.</translation>
    </message>
    <message>
        <source>{0}: one sample is a row of one number per channel, not of shape {1}</source>
        <translation>{0}: ein Messwert ist eine Zeile mit einer Zahl pro Kanal, nicht von der Form {1}</translation>
    </message>
    <message>
        <source>{0}: poses[{1}]: the residual is not the reading minus the prediction: a number was changed. {2}</source>
        <translation>{0}: poses[{1}]: Die Restabweichung ist nicht Messwert minus Vorhersage: Eine Zahl wurde geändert. {2}</translation>
    </message>
    <message>
        <source>{0}: probe.{1} is {2}, but the mesh has {3}. {4}</source>
        <translation>{0}: probe.{1} ist {2}, aber das Netz hat {3}. {4}</translation>
    </message>
    <message>
        <source>{0}: readings cannot be put aside there ({1}): free disk space, or choose a folder on another disk.</source>
        <translation>{0}: Messwerte können dort nicht zwischengespeichert werden ({1}): Geben Sie Speicherplatz frei, oder wählen Sie einen Ordner auf einem anderen Datenträger.</translation>
    </message>
    <message>
        <source>{0}: recording and truth need different files: give them two names.</source>
        <translation>{0}: Aufzeichnung und wahre Werte können nicht eine Datei sein: Geben Sie ihnen zwei Namen.</translation>
    </message>
    <message>
        <source>{0}: regions are read from .json or .csv: choose one of them.</source>
        <translation>{0}: Regionen werden aus .json oder .csv gelesen: Wählen Sie eines davon.</translation>
    </message>
    <message>
        <source>{0}: regions are stored in a probe&apos;s PLY file: load the mesh and save it as .ply.</source>
        <translation>{0}: Regionen stehen in der PLY-Datei einer Sonde: Laden Sie das Netz, und speichern Sie es als .ply.</translation>
    </message>
    <message>
        <source>{0}: regions are written as .json or .csv: end the name in one of them.</source>
        <translation>{0}: Regionen werden als .json oder .csv geschrieben: Lassen Sie den Namen auf eines davon enden.</translation>
    </message>
    <message>
        <source>{0}: regions have the ranks {1}, not 1, 2, and so on. {2}</source>
        <translation>{0}: Die Regionen haben die Ränge {1}, nicht 1, 2 und so weiter. {2}</translation>
    </message>
    <message>
        <source>{0}: regions lists {1} as untouchable, the mesh lists {2}. {3}</source>
        <translation>{0}: Laut regions sind {1} unberührbar, laut Netz {2}. {3}</translation>
    </message>
    <message>
        <source>{0}: regions.{1}.facets is {2}, but the mesh has {3} of that region. {4}</source>
        <translation>{0}: regions.{1}.facets ist {2}, aber das Netz hat {3} in dieser Region. {4}</translation>
    </message>
    <message>
        <source>{0}: regions.{1}.odds is {2}, but its untouchable is {3}. {4}</source>
        <translation>{0}: regions.{1}.odds ist {2}, aber untouchable ist {3}. {4}</translation>
    </message>
    <message>
        <source>{0}: remove the surplus, and write decimals with a point.</source>
        <translation>{0}: Entfernen Sie, was zu viel ist, und schreiben Sie Dezimalzahlen mit Punkt.</translation>
    </message>
    <message>
        <source>{0}: residuals {1}, log odds {2} against as declared.</source>
        <translation>{0}: Restabweichungen {1}, logarithmische Chancen {2} gegenüber „wie angegeben“.</translation>
    </message>
    <message>
        <source>{0}: restore it from an archive, or add the original again.</source>
        <translation>{0}: Stellen Sie es aus einem Archiv wieder her, oder fügen Sie das Original noch einmal hinzu.</translation>
    </message>
    <message>
        <source>{0}: row {1}: the confidence is {2}, not between 0 and 1: locate the contacts again.</source>
        <translation>{0}: Zeile {1}: Die Sicherheit ist {2}, nicht zwischen 0 und 1: Lokalisieren Sie die Kontakte neu.</translation>
    </message>
    <message>
        <source>{0}: row {1}: {2} is not a reason: give a file written by `contactbench locate`.</source>
        <translation>{0}: Zeile {1}: {2} ist kein Grund: eine Datei angeben, die `contactbench locate` geschrieben hat.</translation>
    </message>
    <message>
        <source>{0}: run xacro first, and give the URDF that it makes.</source>
        <translation>{0}: Führen Sie zuerst xacro aus und geben Sie die URDF-Datei an, die dabei entsteht.</translation>
    </message>
    <message>
        <source>{0}: samples are rows (n, c) of one number per channel, not of shape {1}; give a single channel as samples[:, None]</source>
        <translation>{0}: Messwerte sind Zeilen (n, c) mit einer Zahl pro Kanal, nicht von der Form {1}; einen einzelnen Kanal als samples[:, None] angeben</translation>
    </message>
    <message>
        <source>{0}: seconds {1}: give a positive number.</source>
        <translation>{0}: seconds {1}: Geben Sie eine positive Zahl an.</translation>
    </message>
    <message>
        <source>{0}: several frames may be the flange. Name it: {1}@FRAME, with one of {2}.</source>
        <translation>{0}: Mehrere Koordinatensysteme können der Flansch sein. Nennen Sie ihn: {1}@NAME, mit einem von {2}.</translation>
    </message>
    <message>
        <source>{0}: some of these are missing: {1}.</source>
        <translation>{0}: Gebraucht wird {1}; nicht alles davon ist da.</translation>
    </message>
    <message>
        <source>{0}: start_xyz and end_xyz must differ, both are {1}</source>
        <translation>{0}: start_xyz und end_xyz müssen verschieden sein, beide sind {1}</translation>
    </message>
    <message>
        <source>{0}: step {1} of its history, simplify, states no result.deviation.rms_mm: prepare the probe again.</source>
        <translation>{0}: Schritt {1} der Historie, simplify, nennt kein result.deviation.rms_mm: die Sonde neu vorbereiten.</translation>
    </message>
    <message>
        <source>{0}: the 3 x 3 part is not a rotation within 1e-6: it scales or shears. Convert lengths when the mesh is read, and write rotations with at least seven digits.</source>
        <translation>{0}: Der 3 x 3-Teil ist keine Drehung auf 1e-6 genau: Er skaliert oder schert. Rechnen Sie Längen beim Lesen des Netzes um, und schreiben Sie Drehungen mit mindestens sieben Stellen.</translation>
    </message>
    <message>
        <source>{0}: the 3 x 3 part mirrors (determinant -1): one axis has the wrong sign, or the frame is left-handed.</source>
        <translation>{0}: Der 3 x 3-Teil spiegelt (Determinante -1): Eine Achse hat das falsche Vorzeichen, oder das System ist linkshändig.</translation>
    </message>
    <message>
        <source>{0}: the action was not recorded ({1}): free disk space or check the disk, then repeat it. Everything recorded before is safe.</source>
        <translation>{0}: Die Aktion wurde nicht vermerkt ({1}): Schaffen Sie Platz oder prüfen Sie den Datenträger, und wiederholen Sie sie dann. Alles, was vorher aufgezeichnet wurde, ist sicher.</translation>
    </message>
    <message>
        <source>{0}: the archive cannot be unpacked ({1}): check the path and the free space.</source>
        <translation>{0}: Das Archiv kann nicht entpackt werden ({1}): Prüfen Sie den Pfad und den freien Platz.</translation>
    </message>
    <message>
        <source>{0}: the archive cannot be written ({1}): choose another location.</source>
        <translation>{0}: Das Archiv kann nicht geschrieben werden ({1}): Wählen Sie einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: the baud rate must be above 0, not {1}.</source>
        <translation>{0}: Die Baudrate muss über 0 liegen, nicht bei {1}.</translation>
    </message>
    <message>
        <source>{0}: the bench failed: {1}.</source>
        <translation>{0}: Der Messplatz ist gescheitert: {1}.</translation>
    </message>
    <message>
        <source>{0}: the bench is closed: open it again.</source>
        <translation>{0}: Der Messplatz ist geschlossen: Öffnen Sie ihn wieder.</translation>
    </message>
    <message>
        <source>{0}: the bench provides at most {1} Hz</source>
        <translation>{0}: der Messplatz liefert höchstens {1} Hz</translation>
    </message>
    <message>
        <source>{0}: the broker has not answered yet: check that it runs.</source>
        <translation>{0}: Der Broker hat noch nicht geantwortet: Prüfen Sie, ob er läuft.</translation>
    </message>
    <message>
        <source>{0}: the broker refused the connection ({1}): check its settings. Passwords are not supported.</source>
        <translation>{0}: Der Broker hat die Verbindung abgelehnt ({1}): Prüfen Sie seine Einstellungen. Passwörter werden nicht unterstützt.</translation>
    </message>
    <message>
        <source>{0}: the bundle cannot be read ({1}): {2}</source>
        <translation>{0}: Das Paket kann nicht gelesen werden ({1}): {2}</translation>
    </message>
    <message>
        <source>{0}: the bundle cannot be written ({1}): choose a location that is writable and has space.</source>
        <translation>{0}: Das Paket kann nicht geschrieben werden ({1}): einen Ort wählen, der beschreibbar ist und Platz hat.</translation>
    </message>
    <message>
        <source>{0}: the bundle on disk differs from the one that was written: check the disk, then export again.</source>
        <translation>{0}: Das Paket auf dem Datenträger ist nicht das, das geschrieben wurde: Prüfen Sie den Datenträger, dann exportieren Sie erneut.</translation>
    </message>
    <message>
        <source>{0}: the bundle was edited, or is for another runtime: {1} of {2} answers differ, and contacts moved by up to {3} mm. Export the config again with this contactbench.</source>
        <translation>{0}: Das Paket wurde verändert oder ist für eine andere Laufzeit: {1} von {2} Antworten weichen ab, und Kontakte haben sich um bis zu {3} mm verschoben. Die Konfiguration mit diesem contactbench erneut exportieren.</translation>
    </message>
    <message>
        <source>{0}: the clock was set back for one of the two only, so their times do not belong together: cut both before the step.</source>
        <translation>{0}: Die Uhr wurde nur bei einem von beiden zurückgestellt, ihre Zeiten passen also nicht zusammen: beide vor dem Sprung abschneiden.</translation>
    </message>
    <message>
        <source>{0}: the connection to the broker broke; it is tried again.</source>
        <translation>{0}: Die Verbindung zum Broker ist abgebrochen; sie wird erneut versucht.</translation>
    </message>
    <message>
        <source>{0}: the copy cannot be written ({1}): choose another location with --out.</source>
        <translation>{0}: Die Kopie kann nicht geschrieben werden ({1}): Wählen Sie mit --out einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: the disk still rejects writes ({1}): free disk space or check the disk.</source>
        <translation>{0}: Der Datenträger nimmt noch immer nichts an ({1}): Schaffen Sie Platz, oder prüfen Sie den Datenträger.</translation>
    </message>
    <message>
        <source>{0}: the draft cannot be read ({1}): choose the mesh again.</source>
        <translation>{0}: Der Entwurf kann nicht gelesen werden ({1}): Wählen Sie das Netz noch einmal.</translation>
    </message>
    <message>
        <source>{0}: the driver of {1} failed: {2}.</source>
        <translation>{0}: Der Treiber für {1} ist gescheitert: {2}.</translation>
    </message>
    <message>
        <source>{0}: the file cannot be opened ({1}): check its permissions.</source>
        <translation>{0}: Die Datei kann nicht geöffnet werden ({1}): Prüfen Sie ihre Rechte.</translation>
    </message>
    <message>
        <source>{0}: the file cannot be read ({1}): check the path.</source>
        <translation>{0}: Die Datei kann nicht gelesen werden ({1}): Prüfen Sie den Pfad.</translation>
    </message>
    <message>
        <source>{0}: the file cannot be read ({1}): copy it to another disk.</source>
        <translation>{0}: Die Datei kann nicht gelesen werden ({1}): Kopieren Sie sie auf einen anderen Datenträger.</translation>
    </message>
    <message>
        <source>{0}: the file cannot be read ({1}): {2}</source>
        <translation>{0}: Die Datei lässt sich nicht lesen ({1}): {2}</translation>
    </message>
    <message>
        <source>{0}: the file cannot be removed ({1}): check the permissions.</source>
        <translation>{0}: Die Datei kann nicht entfernt werden ({1}): Prüfen Sie die Zugriffsrechte.</translation>
    </message>
    <message>
        <source>{0}: the file has more than {1} bytes: give a robot&apos;s description.</source>
        <translation>{0}: Die Datei hat mehr als {1} Bytes: Geben Sie die Beschreibung eines Roboters an.</translation>
    </message>
    <message>
        <source>{0}: the file is larger than {1} MiB. {2}</source>
        <translation>{0}: Die Datei ist größer als {1} MiB. {2}</translation>
    </message>
    <message>
        <source>{0}: the file is larger than {1} MiB: choose another.</source>
        <translation>{0}: Die Datei ist größer als {1} MiB: eine andere wählen.</translation>
    </message>
    <message>
        <source>{0}: the file is larger than {1} MiB: move it away.</source>
        <translation>{0}: Die Datei ist größer als {1} MiB: Verschieben Sie sie anderswohin.</translation>
    </message>
    <message>
        <source>{0}: the file is larger than {1} MiB: not a bundle.</source>
        <translation>{0}: Die Datei ist größer als {1} MiB: Sie ist kein Paket.</translation>
    </message>
    <message>
        <source>{0}: the file {1} appears twice: {2}</source>
        <translation>{0}: Die Datei {1} kommt zweimal vor: {2}</translation>
    </message>
    <message>
        <source>{0}: the file {1} does not belong in a bundle: remove it.</source>
        <translation>{0}: Die Datei {1} gehört nicht in ein Paket: entfernen.</translation>
    </message>
    <message>
        <source>{0}: the file {1} is missing: {2}</source>
        <translation>{0}: Die Datei {1} fehlt: {2}</translation>
    </message>
    <message>
        <source>{0}: the files are larger than {1} MiB: not a bundle.</source>
        <translation>{0}: Die Dateien sind größer als {1} MiB: Das ist kein Paket.</translation>
    </message>
    <message>
        <source>{0}: the film cannot be written ({1}): choose a folder that exists and has space.</source>
        <translation>{0}: der Film kann nicht geschrieben werden ({1}): einen Ordner wählen, den es gibt und der Platz hat.</translation>
    </message>
    <message>
        <source>{0}: the first two lines are not those of test vectors. {1}</source>
        <translation>{0}: Die ersten zwei Zeilen sind nicht die von Testvektoren. {1}</translation>
    </message>
    <message>
        <source>{0}: the folder cannot be made ({1}): choose another place.</source>
        <translation>{0}: Der Ordner kann nicht angelegt werden ({1}): Wählen Sie einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: the folder cannot be made ({1}): choose one in a place that is writable.</source>
        <translation>{0}: der Ordner kann nicht angelegt werden ({1}): einen an einem beschreibbaren Ort wählen.</translation>
    </message>
    <message>
        <source>{0}: the folder cannot be read ({1}): check the permissions.</source>
        <translation>{0}: Der Ordner kann nicht gelesen werden ({1}): Prüfen Sie die Zugriffsrechte.</translation>
    </message>
    <message>
        <source>{0}: the folder cannot be read ({1}): choose another location.</source>
        <translation>{0}: Der Ordner kann nicht gelesen werden ({1}): Wählen Sie einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: the folder contains {1}, which belongs to no bundle: choose a new or empty folder.</source>
        <translation>{0}: Im Ordner liegt {1}, was zu keinem Paket gehört: einen neuen oder leeren Ordner wählen.</translation>
    </message>
    <message>
        <source>{0}: the folder contains {1}: choose an empty one.</source>
        <translation>{0}: Der Ordner enthält {1}: Wählen Sie einen leeren.</translation>
    </message>
    <message>
        <source>{0}: the force is {1} N, below {2} N, so it is not a touch. Remove the row, or press with 8 to 10 N.</source>
        <translation>{0}: Die Kraft ist {1} N, unter {2} N: keine Berührung. Entfernen Sie die Zeile, oder drücken Sie mit 8 bis 10 N.</translation>
    </message>
    <message>
        <source>{0}: the given normal is {1}° from the mesh normal there. Check its sign and the marker.</source>
        <translation>{0}: Die angegebene Normale weicht dort {1}° von der des Netzes ab. Prüfen Sie ihr Vorzeichen und den Marker.</translation>
    </message>
    <message>
        <source>{0}: the inertia {1} is physically impossible: principal moments {2}, {3}, {4}</source>
        <translation>{0}: Kein Körper hat die Trägheit {1}: Hauptmomente {2}, {3}, {4}</translation>
    </message>
    <message>
        <source>{0}: the journal cannot be read ({1}): choose a session folder.</source>
        <translation>{0}: Das Journal kann nicht gelesen werden ({1}): Wählen Sie einen Sitzungsordner.</translation>
    </message>
    <message>
        <source>{0}: the journal cannot be written ({1}): check the permissions.</source>
        <translation>{0}: Das Journal kann nicht geschrieben werden ({1}): Prüfen Sie die Zugriffsrechte.</translation>
    </message>
    <message>
        <source>{0}: the journal is full ({1} MiB): start a new session.</source>
        <translation>{0}: Das Journal ist voll ({1} MiB): Beginnen Sie eine neue Sitzung.</translation>
    </message>
    <message>
        <source>{0}: the last row is {1}, not [0, 0, 0, 1].{2} Write the translation in the last column.</source>
        <translation>{0}: Die letzte Zeile der Matrix ist {1}, nicht [0, 0, 0, 1].{2} Schreiben Sie die Verschiebung in die letzte Spalte.</translation>
    </message>
    <message>
        <source>{0}: the line is broken. Restore it first.</source>
        <translation>{0}: Die Leitung ist unterbrochen: zuerst wiederherstellen.</translation>
    </message>
    <message>
        <source>{0}: the line is not open: open it first.</source>
        <translation>{0}: die Verbindung ist nicht geöffnet: zuerst öffnen.</translation>
    </message>
    <message>
        <source>{0}: the lock was removed or replaced, so others may be writing: reload the session.</source>
        <translation>{0}: Die Sperre wurde entfernt oder ersetzt, andere könnten also schreiben: Laden Sie die Sitzung neu.</translation>
    </message>
    <message>
        <source>{0}: the marker is over 10 m away: give metres in the mesh&apos;s frame.</source>
        <translation>{0}: Der Marker ist über 10 m entfernt: Geben Sie Meter im System des Netzes an.</translation>
    </message>
    <message>
        <source>{0}: the marker is {1} mm from the mesh. Give the markers in millimetres in the mesh&apos;s own frame, and the mesh they were measured on.</source>
        <translation>{0}: Der Marker ist {1} mm vom Netz entfernt. Geben Sie die Marker in Millimetern im eigenen System des Netzes an, und das Netz, auf dem sie gemessen wurden.</translation>
    </message>
    <message>
        <source>{0}: the marker is {1} mm from the mesh; the nearest point of the mesh is used.</source>
        <translation>{0}: Der Marker ist {1} mm vom Netz entfernt; verwendet wird der nächste Punkt des Netzes.</translation>
    </message>
    <message>
        <source>{0}: the markers cannot be read ({1}): run `session verify`.</source>
        <translation>{0}: Die Marker können nicht gelesen werden ({1}): siehe `session verify`.</translation>
    </message>
    <message>
        <source>{0}: the messages on {1} are written in XCDR2, which contactbench does not read: record with a middleware that writes XCDR1, the default of ROS 2.</source>
        <translation>{0}: Die Nachrichten auf {1} sind in XCDR2 geschrieben, das contactbench nicht liest: mit einer Middleware aufzeichnen, die XCDR1 schreibt, wie es in ROS 2 üblich ist.</translation>
    </message>
    <message>
        <source>{0}: the name of a film must end in .mp4 or .gif.</source>
        <translation>{0}: ein Film endet auf .mp4 oder .gif.</translation>
    </message>
    <message>
        <source>{0}: the name of a recording may have letters, digits, - and _, and must end in .mcap: choose another name.</source>
        <translation>{0}: Der Name einer Aufzeichnung darf Buchstaben, Ziffern, - und _ enthalten und muss auf .mcap enden: Wählen Sie einen anderen.</translation>
    </message>
    <message>
        <source>{0}: the name of a result of this kind must end in {1}.</source>
        <translation>{0}: Der Name eines Ergebnisses dieser Art muss auf {1} enden.</translation>
    </message>
    <message>
        <source>{0}: the name {1} is given twice</source>
        <translation>{0}: Der Name {1} ist doppelt vergeben</translation>
    </message>
    <message>
        <source>{0}: the normal has zero length: leave out all normals, or correct it.</source>
        <translation>{0}: Die Normale hat keine Länge: Lassen Sie alle Normalen weg, oder geben Sie sie an.</translation>
    </message>
    <message>
        <source>{0}: the output would overwrite the input: choose another name for it.</source>
        <translation>{0}: Die Ausgabe würde die Eingabe ersetzen: einen anderen Namen für sie wählen.</translation>
    </message>
    <message>
        <source>{0}: the port cannot be opened ({1}): {2}.</source>
        <translation>{0}: der Anschluss kann nicht geöffnet werden ({1}): {2}.</translation>
    </message>
    <message>
        <source>{0}: the port is not open: open it first.</source>
        <translation>{0}: der Anschluss ist nicht geöffnet: zuerst öffnen.</translation>
    </message>
    <message>
        <source>{0}: the probe cannot be written, there is no folder {1}: make it first.</source>
        <translation>{0}: Die Sonde kann nicht geschrieben werden, es gibt keinen Ordner {1}: Legen Sie ihn zuerst an.</translation>
    </message>
    <message>
        <source>{0}: the probe is not aligned with the sensor, contacts would be drawn at wrong places: align it first.</source>
        <translation>{0}: Die Sonde ist nicht am Sensor ausgerichtet, Kontakte würden an falschen Stellen gezeichnet: Richten Sie sie zuerst aus.</translation>
    </message>
    <message>
        <source>{0}: the rate must be between {1} and {2} Hz, not {3}.</source>
        <translation>{0}: Die Rate muss zwischen {1} und {2} Hz liegen, nicht bei {3}.</translation>
    </message>
    <message>
        <source>{0}: the recording cannot be started ({1}): choose a folder that exists and is writable.</source>
        <translation>{0}: Die Aufzeichnung kann nicht begonnen werden ({1}): Wählen Sie einen Ordner, den es gibt und der beschreibbar ist.</translation>
    </message>
    <message>
        <source>{0}: the recording cannot be started ({1}): choose another disk.</source>
        <translation>{0}: Die Aufzeichnung kann nicht begonnen werden ({1}): Wählen Sie einen anderen Datenträger.</translation>
    </message>
    <message>
        <source>{0}: the recording contains no still pose: hold each pose for a few seconds without touching anything. {1}</source>
        <translation>{0}: Die Aufzeichnung enthält keine ruhige Pose: Halten Sie jede Pose einige Sekunden lang, ohne etwas zu berühren. {1}</translation>
    </message>
    <message>
        <source>{0}: the recording is closed: start a new one.</source>
        <translation>{0}: Die Aufzeichnung ist geschlossen: Beginnen Sie eine neue.</translation>
    </message>
    <message>
        <source>{0}: the recording is too long to read at once: split it.</source>
        <translation>{0}: Die Aufzeichnung ist zu lang, um auf einmal gelesen zu werden: Teilen Sie sie.</translation>
    </message>
    <message>
        <source>{0}: the recording stopped, but its content stays readable ({1}): free disk space or choose another disk, and start a new one.</source>
        <translation>{0}: Die Aufzeichnung hat angehalten, ihr Inhalt bleibt lesbar ({1}): Schaffen Sie Platz, oder wählen Sie einen anderen Datenträger, und beginnen Sie eine neue.</translation>
    </message>
    <message>
        <source>{0}: the recording was written by a newer program ({1}): update contactbench.</source>
        <translation>{0}: Die Aufzeichnung wurde von einem neueren Programm geschrieben ({1}): Aktualisieren Sie contactbench.</translation>
    </message>
    <message>
        <source>{0}: the run has ended.</source>
        <translation>{0}: Der Lauf ist zu Ende.</translation>
    </message>
    <message>
        <source>{0}: the sensor is declared noise-free, so no error may be added. Give a limit as a length.</source>
        <translation>{0}: Der Sensor ist als rauschfrei angegeben, es darf also kein Fehler hinzukommen. Geben Sie eine Grenze als Länge an.</translation>
    </message>
    <message>
        <source>{0}: the session already has a recording with this name: choose another name. Recordings are never overwritten.</source>
        <translation>{0}: Die Sitzung hat schon eine Aufzeichnung dieses Namens: Wählen Sie einen anderen Namen. Aufzeichnungen werden nie überschrieben.</translation>
    </message>
    <message>
        <source>{0}: the session cannot be created ({1}): choose another location.</source>
        <translation>{0}: Die Sitzung kann nicht angelegt werden ({1}): Wählen Sie einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: the session cannot be locked ({1}): make the folder writable, or open the session read-only.</source>
        <translation>{0}: Die Sitzung kann nicht gesperrt werden ({1}): Machen Sie den Ordner beschreibbar, oder öffnen Sie die Sitzung schreibgeschützt.</translation>
    </message>
    <message>
        <source>{0}: the session cannot be migrated to version {1} ({2}): free disk space or check the permissions. The original is unchanged.</source>
        <translation>{0}: Die Sitzung kann nicht auf Version {1} migriert werden ({2}): Schaffen Sie Platz, oder prüfen Sie die Zugriffsrechte. Das Original ist unverändert.</translation>
    </message>
    <message>
        <source>{0}: the session cannot be repaired ({1}): free disk space or check the permissions.</source>
        <translation>{0}: Die Sitzung kann nicht repariert werden ({1}): Schaffen Sie Platz, oder prüfen Sie die Zugriffsrechte.</translation>
    </message>
    <message>
        <source>{0}: the session cannot be written ({1}): check the permissions.</source>
        <translation>{0}: Die Sitzung kann nicht geschrieben werden ({1}): Prüfen Sie die Zugriffsrechte.</translation>
    </message>
    <message>
        <source>{0}: the session contains nothing with the hash {1}: add it first.</source>
        <translation>{0}: Die Sitzung enthält nichts mit dem Hash {1}: Fügen Sie es zuerst hinzu.</translation>
    </message>
    <message>
        <source>{0}: the session has no recording with this name: `session info` lists the recordings.</source>
        <translation>{0}: Die Sitzung hat keine Aufzeichnung mit diesem Namen: `session info` listet sie auf.</translation>
    </message>
    <message>
        <source>{0}: the session has version {1}, but this contactbench knows at most {2}: use a newer contactbench. Nothing was changed.</source>
        <translation>{0}: Die Sitzung hat Version {1}, aber dieses contactbench kennt höchstens {2}: Benutzen Sie ein neueres contactbench. Nichts wurde geändert.</translation>
    </message>
    <message>
        <source>{0}: the session has version {1}, too old for this contactbench: open it with a contactbench that migrates version {2}.</source>
        <translation>{0}: Die Sitzung hat die Version {1}, zu alt für dieses contactbench: Öffnen Sie sie mit einem, das Version {2} migriert.</translation>
    </message>
    <message>
        <source>{0}: the session is open read-only: open it for writing.</source>
        <translation>{0}: Die Sitzung ist schreibgeschützt geöffnet: Öffnen Sie sie zum Schreiben.</translation>
    </message>
    <message>
        <source>{0}: the shape is {1}: give {2} numbers.</source>
        <translation>{0}: Die Form ist {1}: Geben Sie {2} Zahlen an.</translation>
    </message>
    <message>
        <source>{0}: the stream failed: {1}.</source>
        <translation>{0}: Der Datenstrom ist gescheitert: {1}.</translation>
    </message>
    <message>
        <source>{0}: the translation ({1}) mm is {2} m or longer, too long for a mount. Check its unit.</source>
        <translation>{0}: Die Verschiebung ({1}) mm ist {2} m oder länger, zu lang für eine Montage. Prüfen Sie ihre Einheit.</translation>
    </message>
    <message>
        <source>{0}: the unfinished record cannot be cut off ({1}).</source>
        <translation>{0}: Der unvollständige Eintrag kann nicht abgeschnitten werden ({1}).</translation>
    </message>
    <message>
        <source>{0}: the unit cannot be determined. {1}</source>
        <translation>{0}: Die Einheit lässt sich nicht bestimmen. {1}</translation>
    </message>
    <message>
        <source>{0}: the value at {1} is not finite: correct or remove it.</source>
        <translation>{0}: Der Wert bei {1} ist nicht endlich: Berichtigen oder entfernen Sie ihn.</translation>
    </message>
    <message>
        <source>{0}: the {1} cannot be written ({2}): choose a folder that exists, is writable and has space.</source>
        <translation>{0}: {1} nicht geschrieben ({2}): einen Ordner wählen, der existiert, beschreibbar ist und Platz hat.</translation>
    </message>
    <message>
        <source>{0}: the {1} lacks a figure ({2}): {3}.</source>
        <translation>{0}: Es fehlt eine Angabe ({1}, {2}): {3}.</translation>
    </message>
    <message>
        <source>{0}: there are no poses to write: capture some first.</source>
        <translation>{0}: Es gibt keine Posen zu schreiben: Nehmen Sie zuerst einige auf.</translation>
    </message>
    <message>
        <source>{0}: there are no still readings: hold the tool still for a few seconds.</source>
        <translation>{0}: Es gibt keine ruhigen Messungen: das Werkzeug einige Sekunden still halten.</translation>
    </message>
    <message>
        <source>{0}: there are several topics: {1}. Choose one: {2} NAME.</source>
        <translation>{0}: Es gibt mehrere Topics: {1}. Wählen Sie eines: {2} NAME.</translation>
    </message>
    <message>
        <source>{0}: there are {1} files, more than {2}: not a bundle.</source>
        <translation>{0}: Es sind {1} Dateien, mehr als {2}: Das ist kein Paket.</translation>
    </message>
    <message>
        <source>{0}: there are {1} samples, but self_test.samples is {2}. {3}</source>
        <translation>{0}: Es sind {1} Messwerte, self_test.samples ist aber {2}. {3}</translation>
    </message>
    <message>
        <source>{0}: there is already a session here: choose another folder.</source>
        <translation>{0}: Dort gibt es schon eine Sitzung: Wählen Sie einen anderen Ordner.</translation>
    </message>
    <message>
        <source>{0}: there is no bag in it: choose another.</source>
        <translation>{0}: Darin ist kein Bag: eine andere Datei wählen.</translation>
    </message>
    <message>
        <source>{0}: there is no bag in this folder: choose one with .mcap or .db3 files.</source>
        <translation>{0}: In diesem Ordner ist kein Bag: einen Ordner mit .mcap- oder .db3-Dateien wählen.</translation>
    </message>
    <message>
        <source>{0}: there is no folder {1}: create it, or choose another location.</source>
        <translation>{0}: Den Ordner {1} gibt es nicht: Legen Sie ihn an, oder wählen Sie einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: there is no frame {1}; there are: {2}.</source>
        <translation>{0}: Es gibt kein Koordinatensystem {1}; es gibt: {2}.</translation>
    </message>
    <message>
        <source>{0}: there is no result {1} {2}: `session info` lists the results.</source>
        <translation>{0}: Es gibt kein Ergebnis {1} {2}: `session info` listet die Ergebnisse auf.</translation>
    </message>
    <message>
        <source>{0}: there is no such file: check the path.</source>
        <translation>{0}: Diese Datei gibt es nicht: Prüfen Sie den Pfad.</translation>
    </message>
    <message>
        <source>{0}: there is no such folder or zip file: check the path.</source>
        <translation>{0}: Einen solchen Ordner oder eine solche Zip-Datei gibt es nicht: den Pfad prüfen.</translation>
    </message>
    <message>
        <source>{0}: there is no topic of WrenchStamped messages; there are: {1}.</source>
        <translation>{0}: Es gibt kein Topic mit WrenchStamped-Nachrichten; es gibt: {1}.</translation>
    </message>
    <message>
        <source>{0}: there is no version {1}: export the config again.</source>
        <translation>{0}: Eine Version {1} gibt es nicht: die Konfiguration erneut exportieren.</translation>
    </message>
    <message>
        <source>{0}: there is no {1}: add one, compute one with `contactbench session compute`, or name the files.</source>
        <translation>{0}: {1} fehlt: hinzufügen, mit `contactbench session compute` erstellen oder die Dateien nennen.</translation>
    </message>
    <message>
        <source>{0}: these are not numbers ({1}): give shape {2}.</source>
        <translation>{0}: Das sind keine Zahlen ({1}): Geben Sie die Form {2} an.</translation>
    </message>
    <message>
        <source>{0}: this already exists: choose another name.</source>
        <translation>{0}: Das gibt es schon: Wählen Sie einen anderen Namen.</translation>
    </message>
    <message>
        <source>{0}: this calibration cannot be written ({1}): {2}</source>
        <translation>{0}: Diese Kalibrierung kann nicht geschrieben werden ({1}): {2}</translation>
    </message>
    <message>
        <source>{0}: this config of version {1} cannot be migrated ({2}): export it again.</source>
        <translation>{0}: Diese Konfiguration der Version {1} lässt sich nicht übernehmen ({2}): erneut exportieren.</translation>
    </message>
    <message>
        <source>{0}: this file already exists: choose another name.</source>
        <translation>{0}: Diese Datei gibt es schon: Wählen Sie einen anderen Namen.</translation>
    </message>
    <message>
        <source>{0}: this file belongs to another program: move it away, or choose another folder.</source>
        <translation>{0}: Diese Datei gehört zu einem anderen Programm: Verschieben Sie sie, oder wählen Sie einen anderen Ordner.</translation>
    </message>
    <message>
        <source>{0}: this file exists and is never overwritten: choose another name or delete it.</source>
        <translation>{0}: Die Datei besteht schon und wird nicht überschrieben: Wählen Sie einen anderen Namen, oder löschen Sie sie.</translation>
    </message>
    <message>
        <source>{0}: this file exists and is not an archive: choose another name.</source>
        <translation>{0}: Diese Datei gibt es schon, und sie ist kein Archiv: Wählen Sie einen anderen Namen.</translation>
    </message>
    <message>
        <source>{0}: this folder has no metadata.yaml, so it is no bag: choose a file in it: {1}.</source>
        <translation>{0}: In diesem Ordner fehlt metadata.yaml, also ist er kein Bag: eine Datei darin wählen: {1}.</translation>
    </message>
    <message>
        <source>{0}: this is a folder or a device: choose the name of a file.</source>
        <translation>{0}: Das ist ein Ordner oder ein Gerät: den Namen einer Datei wählen.</translation>
    </message>
    <message>
        <source>{0}: this is a folder: choose a CSV file inside it.</source>
        <translation>{0}: Das ist ein Ordner: Wählen Sie eine CSV-Datei darin.</translation>
    </message>
    <message>
        <source>{0}: this is a folder: choose an MCAP file inside it.</source>
        <translation>{0}: Dies ist ein Ordner: Wählen Sie eine MCAP-Datei darin.</translation>
    </message>
    <message>
        <source>{0}: this is a pipe or a device, not a file: copy it to a file first.</source>
        <translation>{0}: Dies ist eine Pipe oder ein Gerät, keine Datei: Kopieren Sie es zuerst in eine Datei.</translation>
    </message>
    <message>
        <source>{0}: this is inside the damaged session: choose another location.</source>
        <translation>{0}: Das liegt in der beschädigten Sitzung: Wählen Sie einen anderen Ort.</translation>
    </message>
    <message>
        <source>{0}: this is inside the session: save the archive elsewhere.</source>
        <translation>{0}: Das liegt in der Sitzung: Speichern Sie das Archiv anderswo.</translation>
    </message>
    <message>
        <source>{0}: this is no virtual bench: choose a mesh instead.</source>
        <translation>{0}: Das ist kein virtueller Prüfstand: Wählen Sie stattdessen ein Netz.</translation>
    </message>
    <message>
        <source>{0}: this is not ASCII, or its last line has no end. {1}</source>
        <translation>{0}: Das ist kein ASCII, oder die letzte Zeile hat kein Ende. {1}</translation>
    </message>
    <message>
        <source>{0}: this is not JSON ({1}): choose another file.</source>
        <translation>{0}: Das ist kein JSON ({1}): Wählen Sie eine andere Datei.</translation>
    </message>
    <message>
        <source>{0}: this is nothing that can be shown: give a recording (.mcap) with its calibration and probe, contacts (.csv), a verification (.json), or the folder of a session.</source>
        <translation>{0}: Diese Datei kann nicht gezeigt werden: Geben Sie eine Aufzeichnung (.mcap) mit Kalibrierung und Sonde, Kontakte (.csv), eine Verifizierung (.json) oder den Ordner einer Sitzung an.</translation>
    </message>
    <message>
        <source>{0}: this is over 1 MiB, too much for an alignment: choose the right file.</source>
        <translation>{0}: Das sind über 1 MiB, zu viel für eine Ausrichtung: Wählen Sie die richtige Datei.</translation>
    </message>
    <message>
        <source>{0}: this kind of result cannot be computed. Known: {1}.</source>
        <translation>{0}: Diese Art von Ergebnis kann nicht berechnet werden. Bekannt: {1}.</translation>
    </message>
    <message>
        <source>{0}: this kind of result cannot be computed: choose one of {1}.</source>
        <translation>{0}: Diese Art von Ergebnis kann nicht berechnet werden: Wählen Sie eine von {1}.</translation>
    </message>
    <message>
        <source>{0}: this recording has already ended.</source>
        <translation>{0}: Diese Aufzeichnung ist schon beendet.</translation>
    </message>
    <message>
        <source>{0}: two files of one input have the same name: rename one.</source>
        <translation>{0}: Zwei Dateien einer Eingabe haben denselben Namen: Benennen Sie eine um.</translation>
    </message>
    <message>
        <source>{0}: two regions have the same name. {1}</source>
        <translation>{0}: Zwei Regionen haben denselben Namen. {1}</translation>
    </message>
    <message>
        <source>{0}: unknown key {1}. Possible: {2}.</source>
        <translation>{0}: {1} ist unbekannt: Möglich ist {2}.</translation>
    </message>
    <message>
        <source>{0}: unpacked it would be larger than {1} MiB: this is not a session.</source>
        <translation>{0}: Entpackt wäre es größer als {1} MiB: Dies ist keine Sitzung.</translation>
    </message>
    <message>
        <source>{0}: version is {1}, not a whole number: {2}</source>
        <translation>{0}: version ist {1}, keine ganze Zahl: {2}</translation>
    </message>
    <message>
        <source>{0}: what is kept there is not used, for others can write it: {1}.</source>
        <translation>{0}: Was dort aufbewahrt ist, wird nicht verwendet, denn andere können dort schreiben: {1}.</translation>
    </message>
    <message>
        <source>{0}: {1} ({2}): choose a folder that exists, is writable and has space.</source>
        <translation>{0}: {1} ({2}): Wählen Sie einen Ordner, der existiert, beschreibbar ist und Platz hat.</translation>
    </message>
    <message>
        <source>{0}: {1} Delete the file: the regions stay as they are, but cannot be undone.</source>
        <translation>{0}: {1} Löschen Sie die Datei: Die Regionen selbst bleiben, wie sie sind, lassen sich aber nicht rückgängig machen.</translation>
    </message>
    <message>
        <source>{0}: {1} Hz is too fast for {2} baud, which carries {3} frames of {4} bytes per second: lower the rate or raise the baud rate.</source>
        <translation>{0}: {1} Hz sind zu schnell für {2} Baud; die Leitung überträgt {3} Frames von {4} Bytes pro Sekunde: die Rate senken oder die Baudrate erhöhen.</translation>
    </message>
    <message>
        <source>{0}: {1} It does not count. Retake it, or continue with {2} poses.</source>
        <translation>{0}: {1} Sie zählt nicht. Nehmen Sie sie neu auf, oder machen Sie mit {2} Posen weiter.</translation>
    </message>
    <message>
        <source>{0}: {1} Or give the delay in seconds.</source>
        <translation>{0}: {1} Oder geben Sie den Verzug in Sekunden an.</translation>
    </message>
    <message>
        <source>{0}: {1} Or give the mesh that they were painted on as a companion of the file.</source>
        <translation>{0}: {1} Oder geben Sie das Netz, auf dem sie gemalt wurden, als Begleiter der Datei an.</translation>
    </message>
    <message>
        <source>{0}: {1} belongs to no record in its journal: this is not a session.</source>
        <translation>{0}: {1} gehört zu keinem Eintrag des Journals: Dies ist keine Sitzung.</translation>
    </message>
    <message>
        <source>{0}: {1} bytes were cut off; the previous journal is kept as {2}.</source>
        <translation>{0}: {1} Byte wurden abgeschnitten; das bisherige Journal bleibt als {2} erhalten.</translation>
    </message>
    <message>
        <source>{0}: {1} cannot be copied into the session ({2}): free disk space or check the disk. Nothing was recorded.</source>
        <translation>{0}: {1} kann nicht in die Sitzung kopiert werden ({2}): Schaffen Sie Platz, oder prüfen Sie den Datenträger. Nichts wurde vermerkt.</translation>
    </message>
    <message>
        <source>{0}: {1} cells; one is needed for each column.</source>
        <translation>{0}: Zellen: {1}; es muss für jede Spalte eine geben.</translation>
    </message>
    <message>
        <source>{0}: {1} does not fit the other fields: {2}</source>
        <translation>{0}: {1} passt nicht zu den anderen Feldern: {2}</translation>
    </message>
    <message>
        <source>{0}: {1} does not have its declared length: {2}</source>
        <translation>{0}: {1} hat nicht die angegebene Länge: {2}</translation>
    </message>
    <message>
        <source>{0}: {1} facets, {2} vertices, {3}.</source>
        <translation>{0}: {1} Facetten, {2} Eckpunkte, {3}.</translation>
    </message>
    <message>
        <source>{0}: {1} files intact, but the bundle is NOT verified. A robot&apos;s runtime refuses it unless told otherwise; for trials only.</source>
        <translation>{0}: {1} Dateien unversehrt, aber das Bundle ist NICHT überprüft. Die Laufzeit eines Roboters lehnt es ab, wenn nicht anders angegeben; nur für Versuche.</translation>
    </message>
    <message>
        <source>{0}: {1} files of {2} MiB: an archive holds at most {3} files and {4} MiB: copy the folder instead.</source>
        <translation>{0}: {1} Dateien mit {2} MiB: Ein Archiv nimmt höchstens {3} Dateien und {4} MiB auf: Kopieren Sie stattdessen den Ordner.</translation>
    </message>
    <message>
        <source>{0}: {1} files, more than {2}: this is not a session.</source>
        <translation>{0}: {1} Dateien, mehr als {2}: Dies ist keine Sitzung.</translation>
    </message>
    <message>
        <source>{0}: {1} has a document type, which no sensor page has: check the address.</source>
        <translation>{0}: {1} hat einen Dokumenttyp, den die Seite eines Sensors nicht hat: die Adresse prüfen.</translation>
    </message>
    <message>
        <source>{0}: {1} has joints: name their robot with --robot NAME.</source>
        <translation>{0}: {1} hat Gelenke: Nennen Sie ihren Roboter mit --robot NAME.</translation>
    </message>
    <message>
        <source>{0}: {1} has {2} bytes, more than {3} MiB: {4}</source>
        <translation>{0}: {1} hat {2} Bytes, mehr als {3} MiB: {4}</translation>
    </message>
    <message>
        <source>{0}: {1} has {2} characters: give a name of at most {3}.</source>
        <translation>{0}: {1} hat {2} Zeichen: Geben Sie einen Namen mit höchstens {3} Zeichen an.</translation>
    </message>
    <message>
        <source>{0}: {1} is a file: choose another name for the folder.</source>
        <translation>{0}: {1} ist eine Datei: für den Ordner einen anderen Namen wählen.</translation>
    </message>
    <message>
        <source>{0}: {1} is a link, folder or device, not a file: {2}</source>
        <translation>{0}: {1} ist ein Link, ein Ordner oder ein Gerät, keine Datei: {2}</translation>
    </message>
    <message>
        <source>{0}: {1} is coupled to another joint or body (mimic or equality): give an arm whose joints move by themselves.</source>
        <translation>{0}: {1} ist mit einem anderen Gelenk oder Körper gekoppelt (mimic oder equality): Geben Sie einen Arm an, dessen Gelenke sich unabhängig bewegen.</translation>
    </message>
    <message>
        <source>{0}: {1} is longer than {2} bytes: check the address.</source>
        <translation>{0}: {1} ist länger als {2} Bytes: die Adresse prüfen.</translation>
    </message>
    <message>
        <source>{0}: {1} is not XML ({2}): check that it is an ATI sensor, or give cpf and cpt in the address.</source>
        <translation>{0}: {1} ist kein XML ({2}): prüfen, ob es ein ATI-Sensor ist, oder cpf und cpt in der Adresse angeben.</translation>
    </message>
    <message>
        <source>{0}: {1} is not a rotation matrix.</source>
        <translation>{0}: {1} ist keine Drehmatrix.</translation>
    </message>
    <message>
        <source>{0}: {1} is not a topic for {2} samples; there are: {3}. Name its device in the description of the recording.</source>
        <translation>{0}: {1} ist kein Topic für Messwerte der Art {2}; es gibt: {3}. Nennen Sie das Gerät in der Beschreibung der Aufzeichnung.</translation>
    </message>
    <message>
        <source>{0}: {1} is not an angle above 0 and up to 180 degrees: set it again.</source>
        <translation>{0}: {1} ist kein Winkel über 0 und bis 180 Grad: Setzen Sie ihn neu.</translation>
    </message>
    <message>
        <source>{0}: {1} is {2}: give a number of millimetres.</source>
        <translation>{0}: {1} ist {2}: Geben Sie eine Zahl in Millimetern an.</translation>
    </message>
    <message>
        <source>{0}: {1} is {2}: {3}</source>
        <translation>{0}: {1} ist {2}: {3}</translation>
    </message>
    <message>
        <source>{0}: {1} lines are more than {2}: split the script.</source>
        <translation>{0}: {1} Zeilen sind mehr als {2}: Teilen Sie die Datei.</translation>
    </message>
    <message>
        <source>{0}: {1} markers, at most {2} are allowed: choose the right file.</source>
        <translation>{0}: {1} Marker, höchstens {2} sind erlaubt: Wählen Sie die richtige Datei.</translation>
    </message>
    <message>
        <source>{0}: {1} mm² before, {2} mm² now ({3} %); lost {4} mm² ({5} %), gained {6} mm² ({7} %).</source>
        <translation>{0}: vorher {1} mm², jetzt {2} mm² ({3} %); verloren {4} mm² ({5} %), gewonnen {6} mm² ({7} %).</translation>
    </message>
    <message>
        <source>{0}: {1} must be finite and above 0, not {2}</source>
        <translation>{0}: {1} muss endlich sein und über 0 liegen, nicht {2}</translation>
    </message>
    <message>
        <source>{0}: {1} must be three finite numbers, not {2}</source>
        <translation>{0}: {1} muss aus drei endlichen Zahlen bestehen, nicht {2}</translation>
    </message>
    <message>
        <source>{0}: {1} of {2} samples are not later than an earlier row: sort them by time, or record again; t must be seconds of one clock.</source>
        <translation>{0}: {1} von {2} Messwerten sind nicht später als einer davor: Sortieren Sie sie nach der Zeit, oder zeichnen Sie neu auf; t muss Sekunden einer einzigen Uhr angeben.</translation>
    </message>
    <message>
        <source>{0}: {1} still poses{2}, {3}: hold more poses still for a few seconds.{4}</source>
        <translation>{0}: ruhige Posen: {1}{2}; {3}: Halten Sie mehr Posen einige Sekunden lang still.{4}</translation>
    </message>
    <message>
        <source>{0}: {1} touches of {2} to {3} N on {4}, located on the full mesh of {5} facets and on {6} simplified. Noise alone gives {7} mm.</source>
        <translation>{0}: {1} Berührungen mit {2} bis {3} N ({4}), geortet auf dem vollen Netz mit {5} Facetten und auf {6} vereinfachten. Rauschen allein ergibt {7} mm.</translation>
    </message>
    <message>
        <source>{0}: {1} was changed: its hash does not match provenance.files: {2}</source>
        <translation>{0}: {1} wurde geändert: Der Hashwert passt nicht zu provenance.files: {2}</translation>
    </message>
    <message>
        <source>{0}: {1} was changed: its hash does not match {2}: {3}</source>
        <translation>{0}: {1} wurde geändert: Der Hashwert passt nicht zu {2}: {3}</translation>
    </message>
    <message>
        <source>{0}: {1} would contain two kinds of samples: rename one.</source>
        <translation>{0}: {1} enthielte zwei Arten von Messwerten: Benennen Sie eine um.</translation>
    </message>
    <message>
        <source>{0}: {1} {2} is no name that every consumer takes: letters, digits and _{3}, in parts with one / between{4}</source>
        <translation>{0}: {1} {2} ist kein Name, den jeder Empfänger annimmt: Buchstaben, Ziffern und _{3}, in Teilen mit je einem / dazwischen{4}</translation>
    </message>
    <message>
        <source>{0}: {1} {2}: give a finite number.</source>
        <translation>{0}: {1} {2}: Geben Sie eine endliche Zahl an.</translation>
    </message>
    <message>
        <source>{0}: {1} {2}: give seconds, 0 or more and at most {3}.</source>
        <translation>{0}: {1} {2}: Geben Sie Sekunden an, mindestens 0 und höchstens {3}.</translation>
    </message>
    <message>
        <source>{0}: {1} {2}: give {3} finite numbers.</source>
        <translation>{0}: {1} {2}: Geben Sie endliche Zahlen an, Anzahl: {3}.</translation>
    </message>
    <message>
        <source>{0}: {1} {2}: pack the bundle&apos;s files with a common program.</source>
        <translation>{0}: {1} {2}: die Dateien des Pakets mit einem üblichen Programm packen.</translation>
    </message>
    <message>
        <source>{0}: {1}: begin with {2}</source>
        <translation>{0}: {1}: mit {2} beginnen</translation>
    </message>
    <message>
        <source>{0}: {1}: check the file.</source>
        <translation>{0}: {1}: Prüfen Sie die Datei.</translation>
    </message>
    <message>
        <source>{0}: {1}: correct it.</source>
        <translation>{0}: {1}: Berichtigen Sie es.</translation>
    </message>
    <message>
        <source>{0}: {1}: give a URDF or MJCF file.</source>
        <translation>{0}: {1}: Geben Sie eine URDF- oder MJCF-Datei an.</translation>
    </message>
    <message>
        <source>{0}: {1}: {2} appears twice: give cpf and cpt in the address.</source>
        <translation>{0}: {1}: {2} kommt zweimal vor: cpf und cpt in der Adresse angeben.</translation>
    </message>
    <message>
        <source>{0}: {1}: {2} is missing: check that it is an ATI sensor, or give cpf and cpt in the address.</source>
        <translation>{0}: {1}: {2} fehlt: prüfen, ob es ein ATI-Sensor ist, oder cpf und cpt in der Adresse angeben.</translation>
    </message>
    <message>
        <source>{0}: {1}: {2} is not one of: {3}.</source>
        <translation>{0}: {1}: {2} ist keines von: {3}.</translation>
    </message>
    <message>
        <source>{0}: {1}: {2}: correct it.</source>
        <translation>{0}: {1}: {2}: Berichtigen Sie es.</translation>
    </message>
    <message>
        <source>{0}: {1}: {2}: this is not a session, or not a safe one.</source>
        <translation>{0}: {1}: {2}: Dies ist keine Sitzung, oder keine sichere.</translation>
    </message>
    <message>
        <source>{0}: {1}: {2}: unknown unit {3}: set the sensor to N and N-m, or give cpf and cpt in the address.</source>
        <translation>{0}: {1}: {2}: Einheit {3} ist unbekannt: den Sensor auf N und N-m stellen oder cpf und cpt in der Adresse angeben.</translation>
    </message>
    <message>
        <source>{0}: {1}: {2}: {3} is not a valid number: give cpf and cpt in the address.</source>
        <translation>{0}: {1}: {2}: {3} ist keine gültige Zahl: cpf und cpt in der Adresse angeben.</translation>
    </message>
    <message>
        <source>{0}; more than {1} mm is refused. {2}</source>
        <translation>{0}; mehr als {1} mm wird abgelehnt. {2}</translation>
    </message>
    <message>
        <source>{0}; more than {1} mm rms is refused. Look for a touching cable, a changed tool or a re-zeroed sensor, and calibrate again.</source>
        <translation>{0}; mehr als {1} mm rms wird abgelehnt. Suchen Sie nach einem anliegenden Kabel, einem geänderten Werkzeug oder einem neu genullten Sensor, und kalibrieren Sie erneut.</translation>
    </message>
    <message>
        <source>{0}; more than {1}° is refused. For this noise the weight is too small, or the tilts are: take more poses, tilted up to 90° about two axes, or mount a heavier load.</source>
        <translation>{0}; mehr als {1}° wird abgelehnt. Für dieses Rauschen ist das Gewicht zu klein, oder die Neigungen sind es: Nehmen Sie mehr Posen auf, um zwei Achsen bis zu 90° geneigt, oder montieren Sie eine schwerere Last.</translation>
    </message>
    <message>
        <source>{0}; none lies inside another. The preparation needs a single body: delete everything that is not the probe in the CAD program, or bridge a narrow gap with a larger --gap.</source>
        <translation>{0}; keines liegt in einem anderen. Die Vorbereitung braucht einen einzigen Körper: Löschen Sie im CAD-Programm, was nicht zur Sonde gehört, oder überbrücken Sie einen schmalen Spalt mit einem größeren --gap.</translation>
    </message>
    <message>
        <source>{0}; the limit for good is {1} mm rms. No action needed.</source>
        <translation>{0}; die Grenze für gut ist {1} mm rms. Nichts zu tun.</translation>
    </message>
    <message>
        <source>{0}; the limit for good is {1} mm. No action needed.</source>
        <translation>{0}; die Grenze für gut ist {1} mm. Nichts zu tun.</translation>
    </message>
    <message>
        <source>{0}; {1} mm rms would be good.</source>
        <translation>{0}; {1} mm rms wären gut.</translation>
    </message>
    <message>
        <source>{0}; {1} mm would be good. One or two more poses will help.</source>
        <translation>{0}; {1} mm wären gut. Eine oder zwei weitere Posen helfen.</translation>
    </message>
    <message>
        <source>{0}; {1} mm would be good. The error is not noise, so more poses will not help.</source>
        <translation>{0}; {1} mm wären gut. Der Fehler ist kein Rauschen, deshalb helfen mehr Posen nicht.</translation>
    </message>
    <message>
        <source>{0}joint angles must be finite (rad), not {1}</source>
        <translation>{0}Gelenkwinkel müssen endlich sein (rad), nicht {1}</translation>
    </message>
    <message>
        <source>{0}joint angles of {1} have the shape {2}, not {3}</source>
        <translation>{0}Gelenkwinkel von {1} haben die Form {2}, nicht {3}</translation>
    </message>
    <message>
        <source>{0}joint {1} is at {2} rad ({3}°), outside its limits {4} .. {5} rad ({6}° .. {7}°){8}</source>
        <translation>{0}Gelenk {1} steht bei {2} rad ({3}°), außerhalb seiner Grenzen {4} .. {5} rad ({6}° .. {7}°){8}</translation>
    </message>
    <message>
        <source>{0}° and {1} mm ({2})</source>
        <translation>{0}° und {1} mm ({2})</translation>
    </message>
    <message>
        <source>{0}°, {1}{2} down</source>
        <translation>{0}°, {1}{2} nach unten</translation>
    </message>
</context>
</TS>
